// Plays the sessions of record_sessions in the WebAssembly module and compares the SHA-256 of all messages.
// Then checks cases that must fail.
//
// usage: node play_sessions.mjs supple_session.wasm FOLDER
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

import {Failure, instantiate, play} from './module_session.mjs';

const [moduleFile, folder] = process.argv.slice(2);
const module = await WebAssembly.compile(readFileSync(moduleFile));
const sessions = JSON.parse(readFileSync(join(folder, 'sessions.json')));
let different = 0, contacts = 0;
for (const session of sessions) {
  const begin = performance.now();
  const {messages, sha256} = await play(module, folder, session);
  const equal = messages === session.messages && sha256 === session.sha256;
  contacts += session.contacts;
  different += equal ? 0 : 1;
  console.log(`${session.name}: ${session.frames} frames, ${session.contacts} contacts, ${Math.round(performance.now() - begin)} ms` +
    (equal ? '' : `: DIFFERENT (${messages} messages, natively ${session.messages})`));
}
assert.ok(contacts > 1000, 'the sessions must have contacts to be compared');
assert.equal(different, 0, 'sessions differ from those of the native build');
const exploding = sessions.find(({name}) => name === 'exploding');
assert.ok(exploding.failures > 0 && exploding.frames > 5, 'an unstable body must not end the session');

// A damaged file must fail with a message that says so.
const damaged = readFileSync(join(folder, 'nine.show'));
damaged[damaged.length - 1] ^= 1;
await assert.rejects(async () => (await instantiate(module)).open(damaged), error => {
  assert.ok(error instanceof Failure);
  assert.match(error.message, /damaged/);
  return true;
});

// Data of another format must also fail.
await assert.rejects(async () => (await instantiate(module)).open(new Uint8Array(3)), Failure);
