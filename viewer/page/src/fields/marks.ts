/** The marks of a field: arrows for vectors, coloured dots for contacts. */
import type { Model } from "../model";
import type { Dots, Lines } from "../view/marks";
import { colourAt, type MapName } from "./colour_maps";
import { COLUMNS, rangeOf, readField } from "./fields";

/** The colours of dots. A shader has room for so many. */
export const DOT_COLOURS = 64;

export const dotColours = (map: MapName): string[] =>
  Array.from({ length: DOT_COLOURS }, (_, i) => `rgb(${colourAt(map, i / (DOT_COLOURS - 1)).join(",")})`);

/** Shorter arrows than this part of the longest one are left out. */
const SHORTEST = 0.02;

/** An arrow at each vertex, or in the middle of each triangle. */
export function fillArrows(arrows: Lines, model: Model): void {
  const data = readField(model);
  const shown = data?.form.vector ? [...data.vectors].filter(([object]) => model.objects[object]!.visible) : [];
  const longest = data ? rangeOf(data, { ...model.field, map: "viridis" })[1] : 0;
  const most = longest > 0 ? shown.reduce((sum, [, vectors]) => sum + vectors.length / 3, 0) : 0;
  arrows.span = model.field.arrowLength;
  arrows.fill(most, (into) => {
    let at = 0;
    for (const [object, vectors] of shown) {
      const { positions, corners } = model.objects[object]!;
      const lengths = data!.values.get(object)!;
      for (let i = 0; i < lengths.length; ++i) {
        if (!(lengths[i]! >= SHORTEST * longest)) continue;
        for (let axis = 0; axis < 3; ++axis) {
          const corner = (k: number) => positions[3 * corners[3 * i + k]! + axis]!;
          into[at + axis] = data!.form.element === "face" ? (corner(0) + corner(1) + corner(2)) / 3 : positions[3 * i + axis]!;
          into[at + 3 + axis] = vectors[3 * i + axis]! / longest;
        }
        at += 6;
      }
    }
    return at / 6;
  });
}

/** Whether both objects of a contact are visible; by its number. */
function visibility({ frame, objects }: Model, section = ""): (contact: number) => boolean {
  if (!frame) return () => false;
  const [ids, stride, second] =
    section === "proximity_points" ? [frame.proximityPairs, 2, 1] as const : section === "impact_points" ? [frame.impacts, 8, 3] as const : [frame.curves, 8, 1] as const;
  return (contact) => [0, second].every((side) => objects[ids[stride * contact + side]!]?.visible);
}

const coloured = new WeakMap<Dots, MapName>();

/** A dot at each contact. */
export function fillDots(dots: Dots, model: Model): void {
  if (coloured.get(dots) !== model.field.map) dots.colours = dotColours(model.field.map);
  coloured.set(dots, model.field.map);
  const data = readField(model);
  const rows = data?.rows ?? new Float32Array(0);
  const [low, high] = data ? rangeOf(data, model.field) : [0, 0];
  const isShown = visibility(model, data?.form.section);
  dots.size = model.pointSize + 6;
  dots.fill(rows.length / COLUMNS, (into) => {
    let at = 0;
    for (let from = 0; from < rows.length; from += COLUMNS) {
      const value = rows[from + data!.form.column!]!;
      if (!Number.isFinite(value) || !isShown(from / COLUMNS)) continue;
      into.set(rows.subarray(from, from + 3), at);
      into[at + 3] = Math.round((DOT_COLOURS - 1) * (high > low ? Math.max(0, Math.min(1, (value - low) / (high - low))) : 0));
      at += 4;
    }
    return at / 4;
  });
}
