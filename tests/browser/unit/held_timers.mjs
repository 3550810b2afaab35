/** Timers that run only when the test says so. Node 18, as Debian 12 has it, takes a list; later ones take an object.
 *  @param {import('node:test').TestContext} t @param {string[]} apis such as ['setTimeout'] */
export function holdTimers(t, apis) {
  try {
    t.mock.timers.enable({ apis });
  } catch {
    t.mock.timers.enable(apis);
  }
}
