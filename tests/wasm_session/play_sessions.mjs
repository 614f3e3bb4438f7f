// Plays the sessions of record_sessions in the WebAssembly module and compares the SHA-256 of all messages.
// Then checks cases that must fail.
//
// usage: node play_sessions.mjs supple_session.wasm FOLDER
import assert from 'node:assert/strict';
import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

const [moduleFile, folder] = process.argv.slice(2);
const module = await WebAssembly.compile(readFileSync(moduleFile));
const statistics = 43, header = 16;

class Failure extends Error {}

/** An instance with only the imports of viewer/wasm/README.md. */
async function instantiate() {
  let memory;
  const view = () => new DataView(memory.buffer);
  const notThere = () => 52;  // ENOSYS: the function does not exist
  const imports = {
    page: {
      fail(pointer, length) {
        throw new Failure(Buffer.from(memory.buffer, pointer, length).toString());
      },
    },
    wasi_snapshot_preview1: {
      clock_time_get(_clock, _precision, at) {
        view().setBigUint64(at, process.hrtime.bigint(), true);
        return 0;
      },
      fd_write: notThere, fd_close: notThere, fd_seek: notThere,
    },
  };
  const {exports} = await WebAssembly.instantiate(module, imports);
  memory = exports.memory;
  exports._initialize();
  const give = (bytes, call) => {
    const pointer = exports.session_memory(bytes.length);
    new Uint8Array(memory.buffer, pointer, bytes.length).set(bytes);
    call(pointer, bytes.length);
  };
  return {
    open: show => give(show, exports.session_open),
    command: text => give(new TextEncoder().encode(text), exports.session_command),
    advance: exports.session_advance,
    /** A copy of the next message, or null. */
    message() {
      const at = exports.session_message();
      if (at === 0) return null;
      assert.equal(at % 16, 0);
      return Buffer.from(memory.buffer.slice(at, at + view().getUint32(at + 8, true)));
    },
  };
}

/** Replaces the statistics, which contain times, by zeros. */
function withoutClocks(message) {
  for (let place = header, i = message.readUInt32LE(12); i > 0; --i) {
    const length = message.readUInt32LE(place + 12), data = place + header;
    if (message.readUInt32LE(place) === statistics) message.fill(0, data, data + length);
    place = data + Math.ceil(length / 16) * 16;
  }
  return message;
}

async function play(session) {
  const instance = await instantiate();
  const hash = createHash('sha256');
  let messages = 0;
  const drain = () => {
    for (let message; (message = instance.message()) !== null; ++messages) hash.update(withoutClocks(message));
  };
  instance.open(readFileSync(join(folder, `${session.name}.show`)));
  drain();
  for (const entry of session.entries) {
    if (typeof entry === 'string') instance.command(entry);
    else instance.advance(entry);
    drain();
  }
  return {messages, sha256: hash.digest('hex')};
}

const sessions = JSON.parse(readFileSync(join(folder, 'sessions.json')));
let different = 0, contacts = 0;
for (const session of sessions) {
  const begin = performance.now();
  const {messages, sha256} = await play(session);
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
await assert.rejects(async () => (await instantiate()).open(damaged), error => {
  assert.ok(error instanceof Failure);
  assert.match(error.message, /damaged/);
  return true;
});

// Data of another format must also fail.
await assert.rejects(async () => (await instantiate()).open(new Uint8Array(3)), Failure);
