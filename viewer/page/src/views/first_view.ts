/** Chooses the view that a page begins with. */
import type { ViewState } from "../view_state";
import { parseView } from "./view_file";

type View = Partial<ViewState>;

export interface FirstView {
  view: View | null;
  /** The step to go to. */
  step: number | undefined;
  /** False when the address has a newer camera. */
  withCamera: boolean;
}

/** The view that the program was started with, or that was exported with the page; null when there is none. */
function embeddedView(): View | null {
  const text = document.getElementById("supple-view")?.textContent;
  return text ? parseView(text) : null;
}

function tried(read: () => View | null, say: (text: string) => void): View | null {
  try {
    return read();
  } catch (error) {
    say((error as Error).message);
    return null;
  }
}

/**
 * A reload shows what was there: the text that the browser `kept`. Otherwise a link comes first, then the view of
 * the program. `say` gets a sentence about a view that cannot be used.
 */
export function firstView(kept: string | null, linked: View | null, say: (text: string) => void): FirstView {
  const [navigation] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  const isReload = navigation?.type === "reload";
  const stored = tried(() => (kept === null ? null : parseView(kept)), () => {});  // of an earlier version
  const given = linked ?? tried(embeddedView, say);
  return {
    view: isReload ? stored ?? given : given ?? stored,
    step: isReload ? undefined : given?.step,
    // A reloaded address may be older than what was stored.
    withCamera: linked !== null || isReload || !location.hash.includes("camera="),
  };
}
