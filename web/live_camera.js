// The camera of a named view: it shows the people of the newest state as large as the view has room for them.
import { axesOf, cameraAt, extentAim, framedPeople, middleOf } from './cameras.js';
import { HeldView } from './held_view.js';
import { ballsOf } from './outline.js';
import { besideCorners, neededHull, placeFor } from './view_frame.js';

/** @typedef {import('./messages.js').CameraView} CameraView
 *  @typedef {import('./view_frame.js').FreeArea} FreeArea */

export class LiveCamera {
  #outlines = /** @type {Map<number, import('./messages.js').OutlinePoint[]>} */ (new Map());  // by character
  #people = /** @type {import('./state_codec.js').Person[]} */ ([]);
  #extent = /** @type {import('./state_codec.js').Extent|null} */ (null);
  #middle = [0, 0, 0];  // of the people on the floor
  #heading = 0;  // by which named views are turned, rad
  #secs = 0;
  #held = new HeldView();
  #aspect = 1;
  #area = /** @type {FreeArea} */ ({ free: { left: 0, top: 0, right: 1, bottom: 1 }, corners: [] });

  /** @param {import('./messages.js').PersonModel[]} people */
  setOutlines(people) {
    const isNew = people.some(({ character }) => !this.#outlines.has(character));
    this.#outlines = new Map(people.map(({ character, outline }) => [character, outline]));
    if (isNew) this.cut();
  }

  /** @param {import('./state_codec.js').State} state  of at least one person
   *  @param {number} reach  see framedPeople()
   *  @returns {number[]} the people's middle on the floor */
  setState(state, reach) {
    this.#heading = state.viewHeading;
    this.#secs = state.sentMicros / 1e6;
    this.#people = framedPeople(state.people, reach);
    this.#extent = null;
    this.#middle = middleOf(this.#people, state.floor);
    return this.#middle;
  }

  /** Of a scene without people.
   *  @param {import('./state_codec.js').Extent} extent */
  setExtent(extent) {
    this.#people = [];
    this.#extent = extent;
  }

  /** @param {number} aspect  width / height of the view */
  setAspect(aspect) {
    if (aspect === this.#aspect) return;
    this.#aspect = aspect;
    this.cut();
  }

  /** @param {FreeArea} area  where the view has room for people */
  setArea(area) {
    this.#area = area;
  }

  /** The next camera does not glide. */
  cut() {
    this.#held.cut();
  }

  /** @param {CameraView} view
   *  @param {number[]} followed  the middle of the people that the view has reached
   *  @returns {import('./cameras.js').Aim} */
  aim(view, followed) {
    const axes = axesOf(view, this.#heading), slope = Math.tan(view.vertical_fov_rad / 2);
    if (this.#people.length === 0 && this.#extent !== null) return extentAim(view, axes, this.#extent, this.#aspect);
    const people = this.#people.map((person) =>
      ({ place: person.links[0].position, balls: ballsOf(person, this.#outlines.get(person.character)) }));
    const needed = neededHull(people, this.#middle, axes);
    const shape = { aspect: this.#aspect, slope, area: this.#area };
    if (people.length === 0) return cameraAt(view, axes, placeFor(needed, shape), followed);
    const place = this.#held.follow(needed, shape, this.#secs);
    const from = this.#middle.map((v, i) => v - followed[i]);
    const away = [axes.right, axes.up, axes.forward].map((axis) => axis[0] * from[0] + axis[1] * from[1] + axis[2] * from[2]);
    return cameraAt(view, axes, besideCorners(place, needed, away, shape), followed);
  }
}
