import assert from 'node:assert/strict';
import test from 'node:test';
import { problemLines } from '../../../web/diagnostics.js';

test('there are no lines without problems', () => {
  assert.deepEqual(problemLines({}, []), []);
  assert.deepEqual(problemLines({ pictures: null }, []), []);
  assert.deepEqual(problemLines({ pictures: { problems: [], last_error: '' }, source: { rejected: {} } }, []), []);
});

test('everybody who is left out is listed with the reason', () => {
  const left_out = [{ character: 3, name: '', reason: '900 km from the others' },
    { character: 4, name: 'Eve', reason: '2.0 km from where it was' }];
  assert.deepEqual(problemLines({ source: { left_out } }, []),
    ['Character 3 is left out: 900 km from the others', 'Eve is left out: 2.0 km from where it was']);
});

test('problems of the picture come first, and datagrams rejected once are no problem of now', () => {
  const told = {
    pictures: { problems: ['mesh hand.stl: no such file'], last_error: 'out of memory' },
    source: { rejected: { 'no MXTP id string': 2, 'cut short': 1 } },
  };
  assert.deepEqual(problemLines(told, ['/api/v1/mesh/0/1/0']), [
    'Server rendering: out of memory',
    'Missing or replaced in the server picture: mesh hand.stl: no such file',
    'This page could not load: /api/v1/mesh/0/1/0',
  ]);
});

test('clocks that differ are listed', () => {
  const clocks = [{ warning: '' }, { warning: 'the clock of /b is 3.00 s behind the server\'s' }];
  assert.deepEqual(problemLines({ stream: { clocks } }, []), ['The clock of /b is 3.00 s behind the server\'s.']);
});

test('what is wrong with people who are shown is listed', () => {
  const problems = ["people are in the frame 'lab', which moves"];
  assert.deepEqual(problemLines({ source: { problems } }, []), ["People are in the frame 'lab', which moves."]);
});

test('a recording that is read up to where it begins says how far', () => {
  assert.deepEqual(problemLines({ source: { passed_secs: 1234.4 } }, []),
    ['The recording is passed over up to the moment at which it is to begin: 1234 s so far']);
  assert.deepEqual(problemLines({ source: { passed_secs: 0 } }, []), []);
});

test('what is not shown of a ROS graph is listed with the reason, and a master that does not answer', () => {
  const ros = { master_uri: 'http://lab:11311', not_shown: ['/cloud: no node publishes it'] };
  assert.deepEqual(problemLines({ ros }, []), ['Not shown: /cloud: no node publishes it']);
  assert.deepEqual(problemLines({ ros, source: { transport: { ros_master_answers: 1 } } }, []).length, 1);
  assert.deepEqual(problemLines({ ros, source: { transport: { ros_master_answers: 0 } } }, []), [
    'No ROS master answers at http://lab:11311: start roscore, or set ROS_MASTER_URI for the server.',
    'Not shown: /cloud: no node publishes it',
  ]);
});

test('equal lines appear once, and long lists are shortened', () => {
  const problems = Array.from({ length: 60 }, (_, i) => `mesh ${i % 40}`);
  const lines = problemLines({ pictures: { problems } }, []);
  assert.equal(lines.length, 12);
  assert.match(lines[11], /^and 29 more, see \/api\/v1\/diagnostics$/);
});
