// A session in the WebAssembly module, under Node.
import assert from 'node:assert/strict';
import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

const statistics = 43, header = 16;

export class Failure extends Error {}

/** An instance of the module with only the imports of viewer/wasm/README.md. */
export async function instantiate(module) {
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

/** Plays a session of record_sessions: its entries, the first ones only when `count` is given. */
export async function play(module, folder, session, count = Infinity) {
  const instance = await instantiate(module);
  const hash = createHash('sha256');
  let messages = 0;
  const drain = () => {
    for (let message; (message = instance.message()) !== null; ++messages) hash.update(withoutClocks(message));
  };
  instance.open(readFileSync(join(folder, `${session.name}.show`)));
  drain();
  for (const entry of session.entries.slice(0, count)) {
    if (typeof entry === 'string') instance.command(entry);
    else instance.advance(entry);
    drain();
  }
  return {messages, sha256: hash.digest('hex')};
}
