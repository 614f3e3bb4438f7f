/** Layers over the surfaces, filled from the newest frame while switched on. */
import * as THREE from "three";
import { GAPS, gapLevel, MARKS } from "../colours";
import { dotColours, fillArrows, fillDots } from "../fields/marks";
import { boundsOf } from "../bounds";
import type { Model, ObjectState } from "../model";
import type { FrameMessage } from "../protocol/messages";
import { Dots, Lines, type Projection } from "./marks";
import { Cells, Faces } from "./primitives";

/** In CSS pixels; closer marks are thinned out. */
const SPACING = 13;

/** Writes the three corners of a triangle and returns the offset after them. */
function writeTriangle(into: Float32Array, at: number, object: ObjectState, triangle: number): number {
  for (let corner = 0; corner < 3; ++corner) {
    const from = 3 * object.corners[3 * triangle + corner]!;
    into[at++] = object.positions[from]!;
    into[at++] = object.positions[from + 1]!;
    into[at++] = object.positions[from + 2]!;
  }
  return at;
}

function writeCentroid(into: Float32Array, at: number, object: ObjectState, triangle: number): number {
  for (let axis = 0; axis < 3; ++axis) {
    let sum = 0;
    for (let corner = 0; corner < 3; ++corner)
      sum += object.positions[3 * object.corners[3 * triangle + corner]! + axis]!;
    into[at++] = sum / 3;
  }
  return at;
}

/** Writes the centre of an object's bounds; false when it has none. */
function writeCentre(into: Float32Array, at: number, object: ObjectState): boolean {
  const bounds = boundsOf(object);
  if (!bounds) return false;
  for (let axis = 0; axis < 3; ++axis) into[at + axis] = (bounds.lower[axis]! + bounds.upper[axis]!) / 2;
  return true;
}

/** The triangles at the vertices that curves enclose: an object and a triangle each. */
function enclosedFaces({ curves, enclosedVertices }: FrameMessage, at: number[], objects: ObjectState[]): number[] {
  const enclosed = new Map<number, Uint8Array>();  // 1 for each enclosed vertex
  for (const i of at) {
    let from = curves[i + 4]!;
    for (const side of [0, 1]) {
      const object = curves[i + side]!;
      if (!enclosed.has(object)) enclosed.set(object, new Uint8Array(objects[object]!.vertices));
      for (const vertex of enclosedVertices.subarray(from, (from += curves[i + 5 + side]!))) enclosed.get(object)![vertex] = 1;
    }
  }
  const faces: number[] = [];
  for (const [object, marks] of enclosed) {
    const { corners } = objects[object]!;
    for (let i = 0; i < corners.length; i += 3)
      if (marks[corners[i]!] || marks[corners[i + 1]!] || marks[corners[i + 2]!]) faces.push(object, i / 3);
  }
  return faces;
}

const ARROW_LINES = 5;

/** Writes a shaft and the four edges of its head. A row has the start, the length and the unit direction. */
function writeArrow(into: Float32Array, at: number, row: Float32Array): void {
  const start = new THREE.Vector3().fromArray(row);
  const length = row[3]!;
  const along = new THREE.Vector3().fromArray(row, 4);
  const tip = start.clone().addScaledVector(along, length);
  const away = Math.abs(along.x) < 0.6 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
  const across = away.cross(along).setLength(0.1 * length);
  const up = along.clone().cross(across);
  const back = tip.clone().addScaledVector(along, -0.25 * length);
  const ends = [start, back.clone().add(across), back.clone().sub(across), back.clone().add(up), back.clone().sub(up)];
  ends.forEach((end, i) => {
    end.toArray(into, at + 6 * i);
    tip.toArray(into, at + 6 * i + 3);
  });
}

/** A set of triangles that can be cleared in constant time. */
class Marks {
  private round = 0;
  private stamps: Uint32Array[] = [];

  fit(objects: ObjectState[]): void {
    this.stamps = objects.map((object) => new Uint32Array(object.triangles));
    this.round = 0;
  }

  begin(): void {
    this.round += 1;
  }

  /** Returns true for the first call with these arguments since the last clear. */
  mark(object: number, triangle: number): boolean {
    const stamps = this.stamps[object]!;
    if (stamps[triangle] === this.round) return false;
    stamps[triangle] = this.round;
    return true;
  }
}

const areShown = (model: Model, a: number, b: number): boolean => Boolean(model.objects[a]?.visible && model.objects[b]?.visible);

/** Calls `visit` with the offset of each point of contacts or impacts whose objects are both visible. */
export function eachContactPoint(model: Model, visit: (data: Float32Array, at: number) => void): void {
  const { frame } = model;
  if (!frame) return;
  const { contacts, impacts } = frame;
  for (let i = 0; i < contacts.length; i += 8) {
    if (!areShown(model, contacts[i]!, contacts[i + 2]!)) continue;
    const first = contacts[i + 6]!;
    for (let k = 0; k < contacts[i + 5]!; ++k) visit(frame.contactPoints, 8 * (first + k));
  }
  for (let i = 0; i < impacts.length; i += 8) if (areShown(model, impacts[i]!, impacts[i + 3]!)) visit(frame.impactPoints, i);
}

/** The same for each segment of a contact, with the offsets of both ends. */
export function eachContactSegment(model: Model, visit: (data: Float32Array, from: number, to: number) => void): void {
  const { frame } = model;
  if (!frame) return;
  const { contacts, contactPoints } = frame;
  for (let i = 0; i < contacts.length; i += 8) {
    const count = contacts[i + 5]!;
    if (count < 2 || !areShown(model, contacts[i]!, contacts[i + 2]!)) continue;
    const first = contacts[i + 6]!;
    const lines = count === 2 ? 1 : count;  // a polygon is closed
    for (let k = 0; k < lines; ++k) visit(contactPoints, 8 * (first + k), 8 * (first + ((k + 1) % count)));
  }
}

export class Layers {
  readonly group = new THREE.Group();
  readonly regions = new Cells("boxes", { colour: "#ffffff", opacity: 0.85 });
  readonly boxes = new Cells("boxes", { colour: "#ffffff", opacity: 0.9 });
  readonly balls = new Cells("balls", { colour: "#ffffff", opacity: 0.8 });
  readonly nodeBoxes = new Cells("boxes", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly nodeBalls = new Cells("balls", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly edges = new Cells("edges", { colour: "#ffffff", opacity: 0.9 });
  readonly nodeEdges = new Cells("edges", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly pairs = new Lines({ colour: MARKS.pair, size: 3, onTop: true, order: 4 });
  readonly candidateFaces = new Faces({ colour: MARKS.candidate, opacity: 0.4, order: 1 });
  readonly candidates = new Lines({ colour: MARKS.candidate, size: 1.5, onTop: true, order: 3 });
  readonly triangles = new Faces({ colour: MARKS.contact, opacity: 0.7, order: 2 });
  readonly points = new Dots({ colour: MARKS.contact, spacing: SPACING, order: 6 });
  readonly normals = new Lines({ colour: MARKS.normal, size: 2, spacing: SPACING, order: 5 });
  readonly segments = new Lines({ colour: MARKS.contact, size: 2.5, order: 5 });
  readonly gapLines = new Lines({ colour: "", colours: GAPS, size: 2, spacing: SPACING, order: 4 });
  readonly proximity = new Dots({ colour: "", colours: GAPS, ring: true, spacing: SPACING, order: 6 });
  readonly depths = new Lines({ colour: MARKS.depth, size: 2.5, spacing: SPACING, order: 5 });
  readonly depthPoints = new Dots({ colour: MARKS.depth, spacing: SPACING, order: 6 });
  readonly curveFaces = new Faces({ colour: MARKS.curve, opacity: 0.4, order: 1 });
  readonly curveArrows = new Lines({ colour: MARKS.curve, size: 3.5, order: 6 });
  readonly curves = new Dots({ colour: MARKS.curve, order: 7 });
  readonly vertices = new Dots({ colour: MARKS.vertex, spacing: SPACING / 2, order: 6 });
  readonly fieldArrows = new Lines({ colour: MARKS.vector, size: 1.5, arrow: true, spacing: 2 * SPACING, order: 7 });
  readonly fieldDots = new Dots({ colour: "", colours: dotColours("viridis"), spacing: SPACING, order: 8 });
  private readonly marks = new Marks();

  constructor(private readonly model: Model) {
    for (const layer of Object.values({ ...this.primitives, ...this.sized })) this.group.add(layer.shape);
    model.on("scene", () => this.marks.fit(model.objects));
  }

  private get primitives() {
    const { regions, boxes, balls, edges, nodeBoxes, nodeBalls, nodeEdges, candidateFaces, triangles, curveFaces } = this;
    return { regions, boxes, balls, edges, nodeBoxes, nodeBalls, nodeEdges, candidateFaces, triangles, curveFaces };
  }

  private get sized() {
    const { pairs, candidates, points, normals, segments, gapLines, proximity, depths, depthPoints, curveArrows, curves, vertices, fieldArrows, fieldDots } = this;
    return { pairs, candidates, points, normals, segments, gapLines, proximity, depths, depthPoints, curveArrows, curves, vertices, fieldArrows, fieldDots };
  }

  /** The number of elements of each layer, also of those that are thinned out. */
  counts(): Record<string, number> {
    return Object.fromEntries(Object.entries({ ...this.primitives, ...this.sized }).map(([name, { count }]) => [name, count]));
  }

  /** Call before each drawing. */
  arrange(projection: Projection): void {
    for (const marks of Object.values(this.sized)) marks.arrange(projection);
  }

  update(): void {
    const { layers } = this.model;
    const { throughSurfaces, pointSize } = this.model;
    for (const cells of [this.nodeBoxes, this.nodeBalls, this.nodeEdges, this.curveFaces]) cells.depthTest = !throughSurfaces;
    for (const marks of Object.values(this.sized)) marks.through = throughSurfaces;
    this.points.size = this.depthPoints.size = pointSize + 2;
    this.proximity.size = this.curves.size = pointSize + 4;
    this.vertices.size = pointSize;
    this.normals.span = this.model.normalLength;
    this.fillCells();
    this.fillPairs(layers.pairs);
    this.fillCandidates(layers.candidates);
    this.fillTriangles(layers.triangles);
    this.fillPoints(layers.points);
    this.fillNormals(layers.normals);
    this.fillSegments(layers.segments);
    this.fillProximity(layers.proximity);
    this.fillDepths(layers.depths);
    this.fillCurves(layers.curves);
    this.fillVertices(layers.vertices);
    fillArrows(this.fieldArrows, this.model);
    fillDots(this.fieldDots, this.model);
  }

  private shown(object: number): boolean {
    return this.model.objects[object]?.visible ?? false;
  }

  private fillCells(): void {
    const { frame, layers } = this.model;
    const ofShown = (on: boolean, cells: Map<number, Float32Array> | undefined) =>
      on && cells ? [...cells].filter(([object]) => this.shown(object)).map(([, data]) => data) : [];
    this.regions.fill(layers.regions && frame ? [frame.sceneRegions] : []);
    this.boxes.fill(ofShown(layers.octree, frame?.octreeBoxes));
    this.balls.fill(ofShown(layers.octree, frame?.octreeSpheres));
    this.edges.fill(ofShown(layers.octree, frame?.octreeEdges));
    this.nodeBoxes.fill(ofShown(layers.nodes, frame?.collidingBoxes));
    this.nodeBalls.fill(ofShown(layers.nodes, frame?.collidingSpheres));
    this.nodeEdges.fill(ofShown(layers.nodes, frame?.collidingEdges));
  }

  private fillPairs(on: boolean): void {
    const pairs = this.model.frame?.objectPairs;
    if (!on || !pairs) return this.pairs.fill(0, () => 0);
    this.pairs.fill(pairs.length / 2, (into) => {
      let at = 0;
      for (let i = 0; i < pairs.length; i += 2) {
        const a = this.model.objects[pairs[i]!]!;
        const b = this.model.objects[pairs[i + 1]!]!;
        if (a.visible && b.visible && writeCentre(into, at, a) && writeCentre(into, at + 3, b)) at += 6;
      }
      return at / 6;
    });
  }

  private fillCandidates(on: boolean): void {
    const pairs = on ? this.model.frame?.candidates : undefined;
    const objects = this.model.objects;
    const count = pairs ? pairs.length / 4 : 0;
    this.candidates.fill(count, (into) => {
      let at = 0;
      for (let i = 0; i < pairs!.length; i += 4) {
        if (!this.shown(pairs![i]!) || !this.shown(pairs![i + 2]!)) continue;
        at = writeCentroid(into, at, objects[pairs![i]!]!, pairs![i + 1]!);
        at = writeCentroid(into, at, objects[pairs![i + 2]!]!, pairs![i + 3]!);
      }
      return at / 6;
    });
    this.fillFaces(this.candidateFaces, pairs ?? new Uint32Array(0), 4, [0, 2], () => true);
  }

  /** Fills the triangles named at two offsets of every `stride` numbers, each once. */
  private fillFaces(
    faces: Faces, data: Uint32Array, stride: number, places: [number, number], isFace: (i: number, side: number) => boolean,
  ): void {
    this.marks.begin();
    faces.fill((2 * data.length) / stride, (into) => {
      let at = 0;
      for (let i = 0; i < data.length; i += stride)
        places.forEach((place, side) => {
          const object = data[i + place]!;
          const triangle = data[i + place + 1]!;
          if (this.shown(object) && isFace(i, side) && this.marks.mark(object, triangle))
            at = writeTriangle(into, at, this.model.objects[object]!, triangle);
        });
      return at / 9;
    });
  }

  private fillTriangles(on: boolean): void {
    const { frame, scene } = this.model;
    const none = new Uint32Array(0);
    if (frame && frame.impacts.length > 0)
      this.fillFaces(this.triangles, on ? frame.impacts : none, 8, [0, 3], (i, side) => scene!.kinds.impact[frame.impacts[i + 6]!]![side] === "face");
    else this.fillFaces(this.triangles, on && frame ? frame.contacts : none, 8, [0, 2], () => true);
  }

  private pointCount(): number {
    const { frame } = this.model;
    return frame ? (frame.contactPoints.length + frame.impactPoints.length) / 8 : 0;
  }

  private fillPoints(on: boolean): void {
    this.points.fill(on ? this.pointCount() : 0, (into) => {
      let at = 0;
      eachContactPoint(this.model, (data, from) => {
        into[at++] = data[from]!;
        into[at++] = data[from + 1]!;
        into[at++] = data[from + 2]!;
      });
      return at / 3;
    });
  }

  private fillNormals(on: boolean): void {
    this.normals.fill(on ? this.pointCount() : 0, (into) => {
      let at = 0;
      eachContactPoint(this.model, (data, from) => {
        for (let axis = 0; axis < 3; ++axis) into[at++] = data[from + axis]!;
        for (let axis = 0; axis < 3; ++axis) into[at++] = data[from + 4 + axis]!;
      });
      return at / 6;
    });
  }

  private fillSegments(on: boolean): void {
    this.segments.fill(on && this.model.frame ? this.model.frame.contactPoints.length / 8 : 0, (into) => {
      let at = 0;
      eachContactSegment(this.model, (data, from, to) => {
        for (const end of [from, to]) for (let axis = 0; axis < 3; ++axis) into[at++] = data[end + axis]!;
      });
      return at / 6;
    });
  }

  /** A ring in the middle of each gap, and a line as long as the gap, coloured by the share of the margins. */
  private fillProximity(on: boolean): void {
    const { frame } = this.model;
    const pairs = on && frame ? frame.proximityPairs : new Uint32Array(0);
    const shown: number[] = [];
    for (let i = 0; i < pairs.length / 2; ++i) if (this.shown(pairs[2 * i]!) && this.shown(pairs[2 * i + 1]!)) shown.push(8 * i);
    const data = frame?.proximityPoints ?? new Float32Array(0);
    this.proximity.fill(shown.length, (into) => {
      shown.forEach((from, k) => {
        for (let axis = 0; axis < 3; ++axis) into[4 * k + axis] = (data[from + axis]! + data[from + 4 + axis]!) / 2;
        into[4 * k + 3] = gapLevel(data[from + 7]!);
      });
      return shown.length;
    });
    this.gapLines.fill(shown.length, (into) => {
      shown.forEach((from, k) => {
        for (let axis = 0; axis < 3; ++axis) {
          into[7 * k + axis] = data[from + axis]!;
          into[7 * k + 3 + axis] = data[from + 4 + axis]!;
        }
        into[7 * k + 6] = gapLevel(data[from + 7]!);
      });
      return shown.length;
    });
  }

  /** Lines from the vertices inside solid objects to the closest points of their surfaces. */
  private fillDepths(on: boolean): void {
    const { frame } = this.model;
    const count = on && frame ? frame.penetrations.length / 4 : 0;
    this.depths.fill(count, (into) => {
      let at = 0;
      for (let i = 0; i < count; ++i) {
        if (!this.shown(frame!.penetrations[4 * i]!) || !this.shown(frame!.penetrations[4 * i + 2]!)) continue;
        for (const end of [0, 4]) for (let axis = 0; axis < 3; ++axis) into[at++] = frame!.penetrationPoints[8 * i + end + axis]!;
      }
      return at / 6;
    });
    this.depthPoints.fill(count, (into) => {
      let at = 0;
      for (let i = 0; i < count; ++i) {
        if (!this.shown(frame!.penetrations[4 * i]!) || !this.shown(frame!.penetrations[4 * i + 2]!)) continue;
        for (let axis = 0; axis < 3; ++axis) into[at++] = frame!.penetrationPoints[8 * i + axis]!;
      }
      return at / 3;
    });
  }

  /** The triangles at the vertices that each curve encloses, and an arrow along its normal, as long as its depth. */
  private fillCurves(on: boolean): void {
    const { frame, objects } = this.model;
    const shown: number[] = [];
    for (let i = 0; on && frame && i < frame.curves.length; i += 8)
      if (this.shown(frame.curves[i]!) && this.shown(frame.curves[i + 1]!)) shown.push(i);
    const faces = frame ? enclosedFaces(frame, shown, objects) : [];
    this.curveFaces.fill(faces.length / 2, (into) => {
      let at = 0;
      for (let i = 0; i < faces.length; i += 2) at = writeTriangle(into, at, objects[faces[i]!]!, faces[i + 1]!);
      return at / 9;
    });
    this.curves.fill(shown.length, (into) => {
      shown.forEach((i, k) => into.set(frame!.curvePoints.subarray(i, i + 3), 3 * k));
      return shown.length;
    });
    this.curveArrows.fill(ARROW_LINES * shown.length, (into) => {
      shown.forEach((i, k) => writeArrow(into, 6 * ARROW_LINES * k, frame!.curvePoints.subarray(i, i + 8)));
      return ARROW_LINES * shown.length;
    });
  }

  private fillVertices(on: boolean): void {
    const groups = on && this.model.frame ? this.model.frame.collidingVertices : new Map<number, Uint32Array>();
    let count = 0;
    for (const vertices of groups.values()) count += vertices.length;
    this.vertices.fill(count, (into) => {
      let at = 0;
      for (const [index, vertices] of groups) {
        if (!this.shown(index)) continue;
        const { positions } = this.model.objects[index]!;
        for (const vertex of vertices)
          for (let axis = 0; axis < 3; ++axis) into[at++] = positions[3 * vertex + axis]!;
      }
      return at / 3;
    });
  }
}
