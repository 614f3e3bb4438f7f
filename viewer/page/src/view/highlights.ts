/** What the user has selected, explained or pulled, drawn over everything else. */
import * as THREE from "three";
import { MARKS, OKABE_ITO } from "../colours";
import { findContact, middleOf, pointsOf, selectableIn } from "../contacts";
import type { Model } from "../model";
import { Dots, Lines, type Projection } from "./marks";
import { Faces } from "./primitives";

export class Highlights {
  readonly group = new THREE.Group();
  private readonly selected = new Faces({ colour: OKABE_ITO.yellow, opacity: 0.9, order: 3 });
  private readonly vertex = new Dots({ colour: MARKS.selection, size: 11, onTop: true, order: 8 });
  private readonly contactDot = new Dots({ colour: MARKS.contact, size: 14, onTop: true, order: 9 });
  private readonly outlines = [OKABE_ITO.orange, OKABE_ITO.sky].map((colour) => new Lines({ colour, size: 2.5, onTop: true, order: 7 }));
  private readonly picked = [OKABE_ITO.orange, OKABE_ITO.sky].map((colour) => new Faces({ colour, opacity: 0.95, order: 4 }));
  private readonly distance = new Lines({ colour: MARKS.selection, size: 2, onTop: true, order: 8 });
  private readonly ruler = new Lines({ colour: MARKS.selection, size: 2.5, onTop: true, order: 8 });
  private readonly pull = new Lines({ colour: MARKS.contact, size: 2.5, onTop: true, order: 8 });
  private readonly sized = [this.vertex, this.contactDot, ...this.outlines, this.distance, this.ruler, this.pull];

  constructor(private readonly model: Model) {
    for (const { shape } of [this.selected, ...this.picked, ...this.sized]) this.group.add(shape);
  }

  update(): void {
    this.fillSelection();
    this.fillExplanation();
  }

  /** Call before each drawing. */
  arrange(projection: Projection): void {
    for (const marks of this.sized) marks.arrange(projection);
  }

  private writeCorners(into: Float32Array, object: number, triangle: number): number {
    const { corners, positions } = this.model.objects[object]!;
    for (let corner = 0; corner < 3; ++corner)
      for (let axis = 0; axis < 3; ++axis)
        into[3 * corner + axis] = positions[3 * corners[3 * triangle + corner]! + axis]!;
    return 1;
  }

  private fillSelection(): void {
    const { selection } = this.model;
    const triangle = selection?.triangle ?? null;
    this.selected.fill(triangle === null ? 0 : 1, (into) => this.writeCorners(into, selection!.object, triangle!));
    const vertex = selection?.vertex ?? null;
    this.vertex.fill(vertex === null ? 0 : 1, (into) => {
      into.set(this.positionOf(selection!.object, vertex!));
      return 1;
    });
    const point = this.contactPoint();
    this.contactDot.fill(point ? 1 : 0, (into) => {
      into.set(point!);
      return 1;
    });
  }

  /** The current position of the selected contact, or null when it has ended. */
  contactPoint(): number[] | null {
    const { contact, frame } = this.model;
    if (!contact || !frame) return null;
    const at = findContact(frame, contact);
    return at < 0 ? null : middleOf(pointsOf(frame, this.model.objects, selectableIn(frame), at));
  }

  private fillExplanation(): void {
    const { explained, explanation } = this.model;
    this.picked.forEach((faces, side) => {
      const of = explained[side];
      faces.fill(of ? 1 : 0, (into) => this.writeCorners(into, of!.object, of!.triangle));
    });
    this.outlines.forEach((lines, side) => {
      const box = explanation?.boxes?.[side];
      const ball = explanation?.spheres?.[side];
      const edges = explanation?.edges?.[side];
      if (edges) lines.fill(edges.length, (into) => writeEdges(into, edges));
      else if (box) lines.fill(12, (into) => writeBox(into, box));
      else if (ball) lines.fill(144, (into) => writeBall(into, ball));
      else lines.fill(0, () => 0);
    });
    const nearest = explanation?.nearest;
    this.ruler.fill(nearest ? 1 : 0, (into) => {
      into.set(nearest!.points.flat());
      return 1;
    });
    const axis = explanation?.axis;
    const span = axis && explanation.distance ? this.distanceSpan(axis, explanation.distance) : null;
    this.distance.fill(span ? 1 : 0, (into) => {
      into.set(span!);
      return 1;
    });
  }

  /** A line as long as the distance between two separated triangles. */
  private distanceSpan(axis: number[], distance: number): number[] | null {
    const { explained, explanation } = this.model;
    const boxes = explanation?.boxes;
    const centres = boxes
      ? boxes.map((box) => box[0]!.map((x, i) => (x + box[1]![i]!) / 2))
      : explained.map(({ object, triangle }) => this.centroid(object, triangle));
    if (centres.length < 2) return null;
    const middle = centres[0]!.map((x, i) => (x + centres[1]![i]!) / 2);
    return [-0.5, 0.5].flatMap((part) => middle.map((x, i) => x + part * distance * axis[i]!));
  }

  centroid(object: number, triangle: number): number[] {
    const corners = new Float32Array(9);
    this.writeCorners(corners, object, triangle);
    return [0, 1, 2].map((axis) => (corners[axis]! + corners[3 + axis]! + corners[6 + axis]!) / 3);
  }

  positionOf(object: number, vertex: number): [number, number, number] {
    const { positions } = this.model.objects[object]!;
    return [positions[3 * vertex]!, positions[3 * vertex + 1]!, positions[3 * vertex + 2]!];
  }

  /** Shows the pulled vertex and its target, or nothing. */
  showPull(from: ArrayLike<number> | null, to: ArrayLike<number> | null): void {
    this.pull.fill(from && to ? 1 : 0, (into) => {
      into.set(from!, 0);
      into.set(to!, 3);
      return 1;
    });
  }
}

function writeEdges(into: Float32Array, edges: number[][][]): number {
  into.set(edges.flat(2));
  return edges.length;
}

function writeBox(into: Float32Array, box: number[][]): number {
  let at = 0;
  for (let axis = 0; axis < 3; ++axis)
    for (const u of [0, 1])
      for (const v of [0, 1])
        for (const t of [0, 1]) {
          const corner = [0, 0, 0];
          corner[axis] = box[t]![axis]!;
          corner[(axis + 1) % 3] = box[u]![(axis + 1) % 3]!;
          corner[(axis + 2) % 3] = box[v]![(axis + 2) % 3]!;
          into.set(corner, at);
          at += 3;
        }
  return 12;
}

/** Writes three circles; a sphere is its centre and radius. */
function writeBall(into: Float32Array, ball: number[]): number {
  const sides = 48;
  let at = 0;
  for (let axis = 0; axis < 3; ++axis)
    for (let i = 0; i < sides; ++i)
      for (const k of [i, i + 1]) {
        const angle = (2 * Math.PI * k) / sides;
        const corner = ball.slice(0, 3);
        corner[axis]! += ball[3]! * Math.cos(angle);
        corner[(axis + 1) % 3]! += ball[3]! * Math.sin(angle);
        into.set(corner, at);
        at += 3;
      }
  return 3 * sides;
}
