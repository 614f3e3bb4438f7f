/** Why the session ended. */
export type EndReason = "lost" | "other-token" | "taken-over" | "program-ended" | "refused" | "failed" | "crowded";

export interface TransportEvents {
  open(): void;
  message(buffer: ArrayBuffer): void;
  end(reason: EndReason, detail: string): void;
}

/** Sends commands, receives messages. A transport that has ended does not restart. */
export interface Transport {
  send(command: Record<string, unknown>): void;
  /** Sends a result to the program that gave this page a job. Resolves when the next one can be sent. */
  deliver?(result: Blob): Promise<void>;
  close(): void;
}
