// The person that the whole page is about: chosen by a card, by a key or by the address. Before anyone is chosen, and
// while the chosen one is away, it is the first in the stream.

export class ChosenPerson {
  /** @type {number|null} */ #wanted = null;
  /** @type {(() => void)[]} */ #followers = [];

  /** @returns {number|null}  character; null: none was chosen */
  get wanted() {
    return this.#wanted;
  }

  /** @param {number|null} character */
  choose(character) {
    if (character === this.#wanted) return;
    this.#wanted = character;
    for (const act of this.#followers) act();
  }

  /** @param {() => void} act  after each choice */
  follow(act) {
    this.#followers.push(act);
  }

  /** @template {{character: number}} T
   *  @param {readonly T[]} people
   *  @returns {T|undefined} */
  of(people) {
    return people.find(({ character }) => character === this.#wanted) ?? people[0];
  }

  /** Goes to the next or the previous of `people`.
   *  @param {readonly {character: number}[]} people
   *  @param {1|-1} by */
  step(people, by) {
    if (people.length === 0) return;
    const at = people.findIndex(({ character }) => character === this.of(people)?.character);
    this.choose(people[(at + by + people.length) % people.length].character);
  }
}
