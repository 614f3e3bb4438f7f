// Plays a session in the WebAssembly module with ever less memory. Where the memory suffices, the messages
// are the same. Where it does not, the module ends with a message of its own that names the memory, and never
// with a trap. A new instance then works.
//
// usage: node exhaust_memory.mjs supple_session.wasm FOLDER
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

import {Failure, play} from './module_session.mjs';

const [moduleFile, folder] = process.argv.slice(2);
const bytes = readFileSync(moduleFile);
const memorySection = 5, frames = 30;

function readNumber(place) {
  let value = 0;
  for (let shift = 0;; shift += 7) {
    const byte = bytes[place++];
    value |= (byte & 127) << shift;
    if (byte < 128) return {value, place};
  }
}

function writeNumber(value) {
  const result = [];
  for (; value > 127; value >>>= 7) result.push((value & 127) | 128);
  return [...result, value];
}

/** The memory section of the module: where it is, and its pages of 64 KiB at the start. */
function findMemory() {
  for (let place = 8; place < bytes.length;) {
    const id = bytes[place], size = readNumber(place + 1), end = size.place + size.value;
    if (id === memorySection) return {begin: place, end, pages: readNumber(size.place + 2).value};
    place = end;
  }
  throw new Error('the module has no memory');
}

const memory = findMemory();

/** The module with a memory that cannot grow beyond this many pages. */
function limitedTo(pages) {
  const limits = [1, 1, ...writeNumber(memory.pages), ...writeNumber(pages)];  // one memory, with a maximum
  const section = [memorySection, ...writeNumber(limits.length), ...limits];
  return WebAssembly.compile(Buffer.concat([bytes.subarray(0, memory.begin), Buffer.from(section), bytes.subarray(memory.end)]));
}

const sessions = JSON.parse(readFileSync(join(folder, 'sessions.json')));
let runs = 0, failures = 0;
for (const name of ['nine', 'exploding', 'Nested', 'Nested_continuous', 'RandomSoups_continuous']) {
  const session = sessions.find(session => session.name === name);
  if (!session) throw new Error(`there is no session ${name}`);
  const whole = await play(await WebAssembly.compile(bytes), folder, session, frames);
  let isEnough = false;
  for (let extra = 0; !isEnough; ++extra) {
    assert.ok(extra < 4096, `${name} takes more than 256 MiB`);
    ++runs;
    try {
      assert.deepEqual(await play(await limitedTo(memory.pages + extra), folder, session, frames), whole);
      isEnough = true;
    } catch (error) {
      assert.ok(error instanceof Failure, `${name} with ${memory.pages + extra} pages: ${error.stack}`);
      assert.match(error.message, /not enough memory/);
      ++failures;
    }
  }
  assert.deepEqual(await play(await WebAssembly.compile(bytes), folder, session, frames), whole);
}
assert.ok(failures > 5, 'memory must run out in several places');
console.log(`${runs} memories, ${failures} of them too small`);
