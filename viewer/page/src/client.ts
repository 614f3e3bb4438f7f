/** Connects transport and model: reads messages, gives credit, matches answers to requests. */
import { Emitter } from "./emitter";
import type { Layer, Model } from "./model";
import type { FailureMessage, FrameText } from "./protocol/messages";
import { readMessage } from "./protocol/read_message";
import { countsOf, type SceneCounts } from "./protocol/read_scene";
import { MessageError } from "./protocol/read_sections";
import type { EndReason, Transport, TransportEvents } from "./transport/transport";

export type Status =
  | { state: "connecting" }
  | { state: "connected" }
  /** `returns`: the page connects again by itself. */
  | { state: "ended"; reason: EndReason | "malformed" | "too-large"; detail: string; returns: boolean };

interface ClientEvents {
  status: Status;
  /** One line about a request of the user. */
  notice: string;
  /** A failure that answers no request, and the layers that it switches off. */
  failure: { text: string; layers: (Layer | "field")[] };
}

/** Frames that may be in transit: one that is drawn, and the next. */
const CREDIT = 2;

/** Pauses before attempts to connect again; the last one repeats. */
const PAUSES_MILLISECONDS = [250, 500, 1000, 2000, 5000];

export class Client extends Emitter<ClientEvents> {
  status: Status = { state: "connecting" };
  /** Whether this page has no commands: it sees what the page that controls the session gets. */
  readonly watches = document.getElementById("supple-spectator") !== null;
  private transport: Transport | null = null;
  private scene: SceneCounts | null = null;
  private credit = 0;
  private nextId = 1;
  private attempts = 0;
  private due: ReturnType<typeof setTimeout> | undefined;
  private readonly questions = new Map<number, { resolve(text: Record<string, unknown>): void; reject(error: Error): void }>();

  constructor(
    private readonly model: Model,
    private readonly open: (events: TransportEvents) => Transport,
    /** Checks whether the scene can be displayed. Returns a sentence about the obstacle, or null. */
    private readonly obstacle: (objects: { name: string; vertices: number; triangles: number }[]) => string | null,
  ) {
    super();
    model.on("request", () => this.send(model.request()));
  }

  connect(): void {
    this.attempts = 0;
    this.setStatus({ state: "connecting" });
    this.attempt();
  }

  private attempt(): void {
    clearTimeout(this.due);
    this.transport?.close();
    this.scene = null;
    this.credit = 0;
    const transport: Transport = this.open({
      open: () => {
        if (transport !== this.transport) return;  // an earlier attempt
        this.attempts = 0;
        this.setStatus({ state: "connected" });
      },
      message: (buffer) => {
        if (transport === this.transport && this.status.state !== "ended") this.receive(buffer);
      },
      end: (reason, detail) => {
        if (transport === this.transport) this.end(reason, detail);
      },
    });
    this.transport = transport;
  }

  send(command: Record<string, unknown>): void {
    if (this.status.state !== "ended" && !this.watches) this.transport?.send(command);
  }

  /** Sends a result to the program (viewer/PROTOCOL.md): what it is, and the content of a file. */
  async deliver(head: Record<string, unknown>, content?: Blob): Promise<void> {
    const text = new TextEncoder().encode(JSON.stringify(head));
    const length = new DataView(new ArrayBuffer(4));
    length.setUint32(0, text.length, true);
    await this.transport?.deliver?.(new Blob([length.buffer, text, content ?? ""]));
  }

  /** Sends a command that has an answer. */
  ask(command: Record<string, unknown>): Promise<Record<string, unknown>> {
    if (this.status.state === "ended") return Promise.reject(new Error("there is no session"));
    if (this.watches) return Promise.reject(new Error("this page only watches"));
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      this.questions.set(id, { resolve, reject });
      this.send({ ...command, id });
    });
  }

  /**
   * Resolves with the first frame from now on that fulfils the condition; gives credit for the frames before
   * it. Rejects with a sentence when the session fails or ends first, or with the reason of `signal`.
   */
  frameThat(isWanted: (frame: FrameText) => boolean, signal: AbortSignal): Promise<FrameText> {
    return new Promise<FrameText>((resolve, reject) => {
      const end = (settle: () => void) => {
        for (const stop of stops) stop();
        signal.removeEventListener("abort", giveUp);
        settle();
      };
      const giveUp = () => end(() => reject(signal.reason as Error));
      const stops = [
        this.model.on("frame", ({ text }) => (isWanted(text) ? end(() => resolve(text)) : this.giveCredit())),
        this.on("failure", ({ text }) => end(() => reject(new Error(`The session has failed: ${text}.`)))),
        this.on("status", ({ state }) => state === "ended" && end(() => reject(new Error("The session has ended.")))),
      ];
      signal.addEventListener("abort", giveUp);
      if (signal.aborted) giveUp();
      else if (this.status.state === "ended") end(() => reject(new Error("The session has ended.")));
      this.giveCredit();  // a hidden page does not draw
    });
  }

  /** Call when a frame can be drawn. Lets the session send the next frames, and play once one was drawn. */
  giveCredit(): void {
    if (!this.scene || this.credit >= CREDIT || this.status.state !== "connected") return;
    this.send({ do: "credit", frames: CREDIT - this.credit });
    this.credit = CREDIT;
  }

  private receive(buffer: ArrayBuffer): void {
    try {
      this.take(buffer);
    } catch (error) {
      if (error instanceof RangeError) this.end("too-large", "The browser does not have enough memory for this scene.");
      else if (error instanceof MessageError) this.end("malformed", `A message cannot be read: ${error.message}.`);
      else throw error;
    }
  }

  private take(buffer: ArrayBuffer): void {
    const message = readMessage(buffer, this.scene);
    switch (message.kind) {
      case "scene": {
        const obstacle = this.obstacle(message.text.objects);
        if (obstacle) return this.end("too-large", obstacle);
        this.scene = countsOf(message);
        this.credit = 0;
        this.model.takeScene(message);
        this.send(this.model.request());
        return;
      }
      case "frame":
        this.credit = Math.max(0, this.credit - 1);
        return this.model.takeFrame(message);
      case "series":
        return this.model.takeSeries(message);
      case "answer":
        this.questions.get(message.text.id)?.resolve(message.text);
        this.questions.delete(message.text.id);
        return;
      case "failure":
        return this.takeFailure(message.text);
    }
  }

  private takeFailure({ message: text, fatal, id, layers }: FailureMessage["text"]): void {
    if (fatal) return this.end("failed", text);
    const question = id === undefined ? undefined : this.questions.get(id);
    if (question) {
      this.questions.delete(id!);
      return question.reject(new Error(text));
    }
    this.emit("failure", { text, layers: layers ? this.model.dropLayers(layers) : [] });
  }

  private end(reason: EndReason | "malformed" | "too-large", detail: string): void {
    this.transport?.close();
    for (const question of this.questions.values()) question.reject(new Error("the session has ended"));
    this.questions.clear();
    const returns = reason === "lost" || reason === "program-ended";
    // The reason of the first failure is more precise than those of later attempts.
    if (this.status.state !== "ended" || !returns) this.setStatus({ state: "ended", reason, detail, returns });
    if (!returns) return;
    clearTimeout(this.due);
    this.due = setTimeout(() => this.attempt(), PAUSES_MILLISECONDS[Math.min(this.attempts, PAUSES_MILLISECONDS.length - 1)]);
    this.attempts += 1;
  }

  private setStatus(status: Status): void {
    this.status = status;
    this.emit("status", status);
  }
}
