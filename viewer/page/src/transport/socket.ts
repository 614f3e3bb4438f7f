import type { EndReason, Transport, TransportEvents } from "./transport";

const REASONS: Record<number, EndReason> = { 4001: "taken-over", 4002: "program-ended", 4003: "refused", 4004: "failed", 4005: "crowded" };

/** Bytes of results that wait to be sent. */
const MOST_BUFFERED = 64_000_000;

/** The session of the program that served this page. */
export function openSocket(events: TransportEvents): Transport {
  const token = new URLSearchParams(location.search).get("token") ?? "";
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  const socket = new WebSocket(`${scheme}//${location.host}/session?token=${encodeURIComponent(token)}`);
  socket.binaryType = "arraybuffer";
  let closed = false;
  socket.onopen = () => events.open();
  socket.onmessage = (event: MessageEvent) => {
    if (event.data instanceof ArrayBuffer) events.message(event.data);
    else events.message(new ArrayBuffer(0));  // text is not a valid message, and the reader reports that
  };
  socket.onclose = (event) => {
    if (closed) return;
    closed = true;
    const reason = REASONS[event.code];
    if (reason) return events.end(reason, event.reason);
    // A refused connection and a missing program look alike; only the page's own address tells which it is.
    fetch(location.href, { method: "HEAD" }).then(
      ({ status }) => events.end(status === 403 ? "other-token" : "lost", ""), () => events.end("lost", ""),
    );
  };
  return {
    send(command) {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(command));
    },
    async deliver(result) {
      socket.send(result);
      while (socket.bufferedAmount > MOST_BUFFERED) await new Promise((done) => setTimeout(done, 5));
    },
    close() {
      closed = true;
      socket.close();
    },
  };
}
