// The people in the view: bodies are made from the model, moved by every state, and given back some time after
// their person has left. World frame: z up, metres.
import * as THREE from 'three';
import { Human } from './human.js';

/** A person who is away for no longer comes back without the model being loaded again: a gap in the stream, or a
 *  model that is a little newer than the state shown. Server's clock. */
const AWAY_MICROS = 10e6;

export class People {
  group = new THREE.Group();
  #people = /** @type {Map<number, {human: Human, seenMicros: number|null}>} */ (new Map());

  /** @param {() => void} onChange  called when a mesh arrived later */
  constructor(onChange) {
    this.onChange = onChange;
  }

  /** @param {import('./messages.js').PersonModel[]} models  whose revision is shown already stay as they are
   *  @param {import('./messages.js').Palette} palette
   *  @param {ReturnType<typeof import('./human.js').makeMarkMaterials>} marks */
  setModels(models, palette, marks) {
    for (const model of models) {
      if (this.has(model.character, model.revision)) continue;
      this.#people.get(model.character)?.human.dispose();
      const human = new Human(model, palette, marks, this.onChange);
      this.#people.set(model.character, { human, seenMicros: null });
      this.group.add(human.group);
    }
  }

  /** @param {number} character
   *  @param {number} revision  of the model */
  has(character, revision) {
    return this.#people.get(character)?.human.revision === revision;
  }

  get size() {
    return this.#people.size;
  }

  get failedMeshes() {
    return [...this.#people.values()].flatMap(({ human }) => human.failedMeshes);
  }

  /** @param {import('./state_codec.js').State} state
   *  @param {boolean} isLive */
  update(state, isLive) {
    for (const [character, entry] of this.#people) {
      const { human } = entry;
      const person = state.people.find((each) => each.character === character);
      human.group.visible = person !== undefined;
      if (person) human.update(person, isLive, state.floor);
      if (person || entry.seenMicros === null) entry.seenMicros = state.sentMicros;
      if (state.sentMicros - entry.seenMicros <= AWAY_MICROS) continue;
      human.dispose();
      this.#people.delete(character);
    }
  }
}
