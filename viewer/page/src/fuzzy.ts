/** How well a text matches what was typed. */

const START = 8;
const RUN = 5;

/**
 * A number above 0 when all letters of `wanted` occur in `text` in this order, larger when they are at the
 * starts of words and next to each other; 0 otherwise. Ignores case; spaces in `wanted` only separate words.
 */
export function fuzzyScore(wanted: string, text: string): number {
  const letters = wanted.toLowerCase().replace(/\s+/g, "");
  const lower = text.toLowerCase();
  if (letters === "") return 1;
  const whole = lower.indexOf(wanted.trim().toLowerCase());
  if (whole >= 0 && isStart(lower, whole)) return 1000 + (whole === 0 ? 100 : 0) - text.length / 100;
  let score = 0;
  let at = -1;
  for (const letter of letters) {
    const next = nextPlace(lower, letter, at);
    if (next < 0) return 0;
    score += next === at + 1 && at >= 0 ? RUN : isStart(lower, next) ? START : 1;
    at = next;
  }
  return Math.max(whole >= 0 ? RUN * letters.length : 0, score - text.length / 100, 0.01);
}

const isStart = (text: string, at: number): boolean => at === 0 || !/[\p{L}\p{N}]/u.test(text[at - 1]!);

/** The letter right after `at`, else at the start of a word, else anywhere. */
function nextPlace(text: string, letter: string, at: number): number {
  if (text[at + 1] === letter) return at + 1;
  const first = text.indexOf(letter, at + 1);
  for (let next = first; next >= 0; next = text.indexOf(letter, next + 1)) if (isStart(text, next)) return next;
  return first;
}
