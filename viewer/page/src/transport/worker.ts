import type { Transport, TransportEvents } from "./transport";
import SessionWorker from "./session_worker?worker&inline";

const MODULE_ID = "supple-wasm";
const SCENE_ID = "supple-scene";

/** Whether this page contains the library and a scene. */
export function hasCargo(): boolean {
  return document.getElementById(MODULE_ID) !== null && document.getElementById(SCENE_ID) !== null;
}

function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function unpackCargo(id: string): Promise<ArrayBuffer> {
  const packed = new Blob([bytesOfBase64(document.getElementById(id)!.textContent!.trim())]);
  return new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

/** Starts the session of this page in a worker. */
export function openWorker(events: TransportEvents): Transport {
  let worker: Worker | null = null;
  let closed = false;
  const end = (detail: string) => {
    if (closed) return;
    closed = true;
    worker?.terminate();
    events.end("failed", detail);
  };
  const start = async () => {
    const [module, scene] = await Promise.all([unpackCargo(MODULE_ID), unpackCargo(SCENE_ID)]);
    if (closed) return;
    worker = new SessionWorker();
    worker.onerror = (event) => end(event.message || "the worker could not be started");
    worker.onmessage = (event: MessageEvent) => {
      if (event.data instanceof ArrayBuffer) events.message(event.data);
      else if ("failed" in event.data) end(String(event.data.failed));
      else events.open();
    };
    worker.postMessage({ module, scene }, [module, scene]);
  };
  start().catch((error: unknown) => end(`the contents of this page cannot be unpacked: ${String(error)}`));
  return {
    send: (command) => worker?.postMessage(JSON.stringify(command)),
    close() {
      closed = true;
      worker?.terminate();
    },
  };
}
