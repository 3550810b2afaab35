// The people in the view: bodies are created from the model, moved by every state, and freed some time after their
// person has left. World frame: z up, metres.
import * as THREE from 'three';
import { Human } from './human.js';

/** Time after which the body of a missing person is freed, by the server's clock. After shorter gaps in the stream, or
 *  if the model is slightly newer than the state shown, the model need not be loaded again. */
const AWAY_MICROS = 10e6;

export class People {
  group = new THREE.Group();
  #people = /** @type {Map<number, {human: Human, seenMicros: number|null}>} */ (new Map());

  #look = /** @type {import('./human.js').HumanLook} */ ({ loads: 'spheres', style: 'matte', hidden: [] });
  #isCoarse = false;

  /** @param {() => void} onChange  called whenever a mesh has been loaded */
  constructor(onChange) {
    this.onChange = onChange;
  }

  /** @param {import('./messages.js').PersonModel[]} models  those with a revision already shown are skipped
   *  @param {import('./messages.js').Palette} palette
   *  @param {ReturnType<typeof import('./human.js').makeMarkerMaterials>} markers */
  setModels(models, palette, markers) {
    for (const model of models) {
      if (this.has(model.character, model.revision)) continue;
      this.#people.get(model.character)?.human.dispose();
      const human = new Human(model, palette, markers, this.#look, this.onChange);
      human.setCoarse(this.#isCoarse);
      this.#people.set(model.character, { human, seenMicros: null });
      this.group.add(human.group);
    }
  }

  /** @param {import('./human.js').HumanLook} look  from the next update on */
  setLook(look) {
    this.#look = look;
    for (const { human } of this.#people.values()) human.setLook(look);
  }

  /** @param {boolean} isCoarse  whether skins of fewer triangles will do */
  setCoarse(isCoarse) {
    this.#isCoarse = isCoarse;
    for (const { human } of this.#people.values()) human.setCoarse(isCoarse);
  }

  /** All bodies. */
  clear() {
    for (const { human } of this.#people.values()) human.dispose();
    this.#people.clear();
  }

  /** Whether any person is drawn as a skin. */
  get hasSkins() {
    return [...this.#people.values()].some(({ human }) => human.hasSkin);
  }

  /** @param {number} character
   *  @param {number} revision  of the model */
  has(character, revision) {
    return this.#people.get(character)?.human.revision === revision;
  }

  /** Whether nothing of the bodies is still to be loaded. */
  get isComplete() {
    return [...this.#people.values()].every(({ human }) => human.isComplete);
  }

  /** Before they are drawn.
   *  @param {THREE.WebGLRenderer} renderer */
  pose(renderer) {
    for (const { human } of this.#people.values()) if (human.group.visible) human.pose(renderer);
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
