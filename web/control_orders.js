// Sends orders of operators to the server.
import { messageOf, request } from './server_api.js';

const HEADERS = { 'Content-Type': 'application/json' };

/** @param {(text: string) => void} notice  shows why an order was refused
 *  @returns {(route: string, order: object, what: string) => Promise<unknown>}  `what`: "start the recording"; resolves to
 *    the answer, or null if it was refused */
export const makeOrders = (notice) => async (route, order, what) => {
  try {
    const answer = await request(route, { method: 'POST', headers: HEADERS, body: JSON.stringify(order) });
    return await answer.json();
  } catch (error) {
    notice(`Could not ${what}: ${messageOf(error)}`);
    return null;
  }
};
