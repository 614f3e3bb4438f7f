/** How fast frames come, and how fast the time of the scene passes. */

/** Over a shorter time, frames that came at once would say that time flies. */
const LEAST_MILLISECONDS = 300;

export class Pace {
  /** The frames of the last second and the one before them: when each came, and its simulated time. */
  private frames: { at: number; time: number }[] = [];

  add(at: number, time: number): void {
    const last = this.frames.at(-1);
    if (last && time < last.time) this.clear();
    this.frames.push({ at, time });
  }

  clear(): void {
    this.frames = [];
  }

  /** Frames per second, and seconds of the scene in a second; null when that is not known. */
  at(now: number): { rate: number; factor: number | null } {
    const recent = this.frames.filter(({ at }) => at > now - 1000).length;
    this.frames = this.frames.slice(-recent - 1);
    const [first, last] = [this.frames[0], this.frames.at(-1)];
    const isKnown = first && last && recent > 0 && last.at - first.at >= LEAST_MILLISECONDS;
    return { rate: recent, factor: isKnown ? (1000 * (last.time - first.time)) / (last.at - first.at) : null };
  }
}
