/** Why there is no session any more. */
export type EndReason = "lost" | "taken-over" | "program-ended" | "refused" | "failed";

export interface TransportEvents {
  open(): void;
  message(buffer: ArrayBuffer): void;
  end(reason: EndReason, detail: string): void;
}

/** Commands go out, messages come in; a transport that has ended stays so. */
export interface Transport {
  send(command: Record<string, unknown>): void;
  close(): void;
}
