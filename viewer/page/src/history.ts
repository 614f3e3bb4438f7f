/** Numbers and events of the frames of a recording, or of the last steps. */
import type { EventKind } from "./protocol/messages";

export interface Event {
  frame: number;
  a: number;
  b: number;
}
export type Events = Record<EventKind, { begin: Event[]; end: Event[] }>;
const noEvents = (): Events => ({ contact: { begin: [], end: [] }, narrow_phase: { begin: [], end: [] }, volume: { begin: [], end: [] } });

export function eventsOf(data: Uint32Array): Event[] {
  return Array.from({ length: data.length / 3 }, (_, i) => ({ frame: data[3 * i]!, a: data[3 * i + 1]!, b: data[3 * i + 2]! }));
}

export const EVENT_LABELS: Record<EventKind, string> = { contact: "contacts", narrow_phase: "narrow phase", volume: "broad phase" };

const MOST_ROWS = 4000;

/** Rows of numbers: one per frame of a recording, one per step of a simulation, of the last steps. */
export class History {
  names: string[] = [];
  columns: number[][] = [];
  frames: number[] = [];
  events = noEvents();
  /** The rows of a simulation that are kept. */
  most = MOST_ROWS;

  reset(names: string[]): void {
    this.names = names;
    this.columns = names.map(() => []);
    this.frames = [];
    this.events = noEvents();
  }

  get last(): number {
    return this.frames[this.frames.length - 1] ?? -1;
  }

  push(frame: number, time: number, statistics: ArrayLike<number>): void {
    this.frames.push(frame);
    this.columns[0]!.push(time);
    for (let i = 1; i < this.columns.length; ++i) this.columns[i]!.push(statistics[i - 1] ?? NaN);
    if (this.frames.length <= this.most) return;
    const surplus = this.most / 4;  // remove many rows at once, so that the cost per frame is small
    this.frames.splice(0, surplus);
    for (const column of this.columns) column.splice(0, surplus);
    const first = this.frames[0]!;
    for (const events of Object.values(this.events)) {
      events.begin = events.begin.filter((event) => event.frame >= first);
      events.end = events.end.filter((event) => event.frame >= first);
    }
  }

  column(name: string): number[] | null {
    const at = this.names.indexOf(name);
    return at < 0 ? null : this.columns[at]!;
  }
}
