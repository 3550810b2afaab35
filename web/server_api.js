// Requests to the routes of the server, with errors of one line: the server may be unreachable, reject the request, or
// be behind a proxy that answers with a page of its own.
import { readRejection } from './messages.js';

/** @param {unknown} error  any thrown value */
export const messageOf = (error) => (error instanceof Error ? error.message : String(error));

/** The server cannot be reached: what was asked did not happen, and may be asked again. */
export class NoConnection extends Error {
  constructor() {
    super('no connection to the server');
  }
}

// A page of another site cannot add this header. It shows the server that its own page sends the request, also where
// browsers send no Sec-Fetch-Site: without TLS, to other machines.
const FROM_THIS_PAGE = { 'X-Kinescope-Page': '1' };

/** @template T
 *  @param {string} route
 *  @param {import('./messages.js').Reader<T>} read
 *  @returns {Promise<T|null>}  null if the server is unreachable, which the status indicator shows
 *  @throws {Error} if the request is rejected or the answer has another shape */
export async function ask(route, read) {
  const answer = await fetch(route, { headers: FROM_THIS_PAGE }).catch(() => null);
  if (answer === null) return null;
  if (!answer.ok) throw new Error(await rejectionOf(answer));
  return read(await jsonOf(answer, route), route);
}

/** @param {string|URL} route
 *  @param {RequestInit} [options]
 *  @returns {Promise<Response>}
 *  @throws {NoConnection} if the server is unreachable
 *  @throws {Error} if it rejects the request */
export async function request(route, options) {
  const answer = await fetch(route, { ...options, headers: { ...options?.headers, ...FROM_THIS_PAGE } }).catch(() => null);
  if (answer === null) throw new NoConnection();
  if (!answer.ok) throw new Error(await rejectionOf(answer));
  return answer;
}

/** @param {Response} answer
 *  @param {string} route
 *  @returns {Promise<unknown>} */
async function jsonOf(answer, route) {
  try {
    return await answer.json();
  } catch {
    const type = answer.headers.get('Content-Type') ?? 'no content type';
    throw new Error(`${route} returned ${type}, expected JSON; check for a proxy in front of the server`);
  }
}

/** @param {Response} answer  with an error status
 *  @returns {Promise<string>}  the server's message, or the status if the answer is not from the server */
export const rejectionOf = async (answer) => await ownRejectionOf(answer) ?? `HTTP status ${answer.status}`;

/** @param {Response} answer  with an error status
 *  @returns {Promise<string|null>}  the server's message; null if the answer is not from a Kinescope server */
export async function ownRejectionOf(answer) {
  try {
    return readRejection(await answer.json(), '').error;
  } catch {
    return null;
  }
}
