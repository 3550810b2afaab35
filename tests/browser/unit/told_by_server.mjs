// Messages that the C++ encoder has just written (page_fixture_server describe), and the values in them.
import { execFileSync } from 'node:child_process';

const program = process.env.KINESCOPE_PAGE_FIXTURE;
if (!program) throw new Error('set KINESCOPE_PAGE_FIXTURE to the built page_fixture_server; ctest does it');

export const told = JSON.parse(execFileSync(program, ['describe'], { encoding: 'utf8', maxBuffer: 1 << 26 }));

/** @param {string} hex  of a message, or of a skin */
export const toBuffer = (hex) => Uint8Array.from(Buffer.from(hex, 'hex')).buffer;

/** A message with two people, gloves and an object: `told.state`. */
export const stateMessage = toBuffer(told.hex);
