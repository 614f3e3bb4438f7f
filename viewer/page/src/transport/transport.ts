/** Why the session ended. */
export type EndReason = "lost" | "other-token" | "taken-over" | "program-ended" | "refused" | "failed";

export interface TransportEvents {
  open(): void;
  message(buffer: ArrayBuffer): void;
  end(reason: EndReason, detail: string): void;
}

/** Sends commands, receives messages. A transport that has ended does not restart. */
export interface Transport {
  send(command: Record<string, unknown>): void;
  close(): void;
}
