/**
 * The session in a worker, from the WebAssembly module of the library. Commands arrive as strings; messages
 * leave as array buffers that are transferred, not copied.
 */

interface Exports {
  memory: WebAssembly.Memory;
  _initialize?(): void;
  session_memory(length: number): number;
  session_open(pointer: number, length: number): void;
  session_command(pointer: number, length: number): void;
  session_advance(milliseconds: number): number;
  session_message(): number;
}

/** A failure after which the module is unusable. */
class ModuleFailure extends Error {}

const scope = self as unknown as {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: unknown, transfer?: Transferable[]): void;
};

let exports: Exports | null = null;
let timer: ReturnType<typeof setTimeout> | undefined;
let last = 0;
/** Schedules a task without delay; `setTimeout` would wait four milliseconds. */
const soon = new MessageChannel();
let turnIsDue = false;
soon.port1.onmessage = () => {
  turnIsDue = false;
  turn();
};

const ERRNO_NOSYS = 52;
const ERRNO_SUCCESS = 0;

/** The few WASI functions that a module without files needs. All others return “not supported”. */
function wasiCall(name: string): (...args: number[]) => number {
  const view = () => new DataView(exports!.memory.buffer);
  switch (name) {
    case "clock_time_get":
      return (_clock, _precision, at) => {
        view().setBigUint64(at!, BigInt(Math.round(performance.now() * 1e6)), true);
        return ERRNO_SUCCESS;
      };
    case "fd_write":
      return (_file, vectors, count, written) => {
        let length = 0;
        for (let i = 0; i < count!; ++i) length += view().getUint32(vectors! + 8 * i + 4, true);
        view().setUint32(written!, length, true);
        return ERRNO_SUCCESS;
      };
    case "random_get":
      return (at, length) => {
        crypto.getRandomValues(new Uint8Array(exports!.memory.buffer, at, length));
        return ERRNO_SUCCESS;
      };
    case "environ_sizes_get":
    case "args_sizes_get":
      return (count, size) => {
        view().setUint32(count!, 0, true);
        view().setUint32(size!, 0, true);
        return ERRNO_SUCCESS;
      };
    case "environ_get":
    case "args_get":
      return () => ERRNO_SUCCESS;
    case "proc_exit":
      return (status) => {
        throw new ModuleFailure(`the library stopped with status ${status}`);
      };
    default:
      return () => ERRNO_NOSYS;
  }
}

function readText(pointer: number, length: number): string {
  return new TextDecoder().decode(new Uint8Array(exports!.memory.buffer, pointer, length));
}

function importsOf(module: WebAssembly.Module): WebAssembly.Imports {
  const imports: Record<string, Record<string, WebAssembly.ImportValue>> = {};
  for (const wanted of WebAssembly.Module.imports(module)) {
    if (wanted.kind !== "function") continue;
    const group = (imports[wanted.module] ??= {});
    group[wanted.name] =
      wanted.name === "fail"
        ? (pointer: number, length: number) => {
            throw new ModuleFailure(readText(pointer, length));
          }
        : wasiCall(wanted.name);
  }
  return imports;
}

/** Calls a function of the module with bytes that are copied into its memory. */
function give(bytes: Uint8Array, call: (pointer: number, length: number) => void): void {
  const pointer = exports!.session_memory(bytes.length);
  new Uint8Array(exports!.memory.buffer, pointer, bytes.length).set(bytes);
  call(pointer, bytes.length);
}

function postMessages(): void {
  for (;;) {
    const at = exports!.session_message();
    if (at === 0) return;
    const length = new DataView(exports!.memory.buffer).getUint32(at + 8, true);
    const message = exports!.memory.buffer.slice(at, at + length);
    scope.postMessage(message, [message]);
  }
}

function plan(milliseconds: number): void {
  clearTimeout(timer);
  if (milliseconds > 0) {
    timer = setTimeout(turn, Math.min(milliseconds, 1000));
  } else if (!turnIsDue) {
    turnIsDue = true;
    soon.port2.postMessage(0);
  }
}

function attempt(action: () => void): void {
  try {
    action();
  } catch (error) {
    exports = null;
    clearTimeout(timer);
    scope.postMessage({ failed: error instanceof Error ? error.message : String(error) });
  }
}

function turn(): void {
  if (!exports) return;
  attempt(() => {
    const now = performance.now();
    const idle = exports!.session_advance(now - last);
    last = now;
    postMessages();
    plan(idle);
  });
}

async function open(module: BufferSource, scene: Uint8Array): Promise<void> {
  const compiled = await WebAssembly.compile(module);
  const instance = await WebAssembly.instantiate(compiled, importsOf(compiled));
  exports = instance.exports as unknown as Exports;
  exports._initialize?.();
  give(scene, exports.session_open);
  last = performance.now();
  scope.postMessage({ opened: true });
  turn();
}

scope.onmessage = (event: MessageEvent) => {
  const data = event.data as string | { module: ArrayBuffer; scene: ArrayBuffer };
  if (typeof data === "string") {
    if (exports)
      attempt(() => {
        give(new TextEncoder().encode(data), exports!.session_command);
        postMessages();
        plan(0);
      });
    return;
  }
  open(data.module, new Uint8Array(data.scene)).catch((error: unknown) =>
    attempt(() => {
      throw error;
    }),
  );
};
