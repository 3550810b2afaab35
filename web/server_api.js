// Asks the server's routes, and says in one line what went wrong: the server may be gone, refuse, or be hidden
// behind a proxy that answers with a page of its own.
import { readRefusal } from './messages.js';

/** @param {unknown} error  whatever was thrown */
export const messageOf = (error) => (error instanceof Error ? error.message : String(error));

/** @template T
 *  @param {string} route
 *  @param {import('./messages.js').Reader<T>} read
 *  @returns {Promise<T|null>}  null where no server answers, which the lamp tells
 *  @throws {Error} where the answer is a refusal, or not what it should be */
export async function ask(route, read) {
  const answer = await fetch(route).catch(() => null);
  if (answer === null) return null;
  if (!answer.ok) throw new Error(await refusalOf(answer));
  return read(await jsonOf(answer, route), route);
}

/** @param {Response} answer
 *  @param {string} route
 *  @returns {Promise<unknown>} */
async function jsonOf(answer, route) {
  try {
    return await answer.json();
  } catch {
    const type = answer.headers.get('Content-Type') ?? 'no content type';
    throw new Error(`${route} is answered with ${type}, expected JSON: is a proxy in between?`);
  }
}

/** @param {Response} answer  that is not ok
 *  @returns {Promise<string>}  the server's message, or the status if the answer is not the server's */
export const refusalOf = async (answer) => await ownRefusalOf(answer) ?? `HTTP status ${answer.status}`;

/** @param {Response} answer  that is not ok
 *  @returns {Promise<string|null>}  null where it is not our server that refuses */
export async function ownRefusalOf(answer) {
  try {
    return readRefusal(await answer.json(), '').error;
  } catch {
    return null;
  }
}
