/** Layers over the surfaces, filled from the newest frame while switched on. */
import * as THREE from "three";
import { OKABE_ITO, proximityLevel } from "../colours";
import { boundsOf, type Model, type ObjectState } from "../model";
import type { FrameMessage } from "../protocol/messages";
import { Cells, Dots, Faces, Lines } from "./primitives";

const CONTACT = OKABE_ITO.vermillion;

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

export class Layers {
  readonly group = new THREE.Group();
  readonly regions = new Cells("boxes", { colour: "#ffffff", opacity: 0.85 });
  readonly boxes = new Cells("boxes", { colour: "#ffffff", opacity: 0.9 });
  readonly balls = new Cells("balls", { colour: "#ffffff", opacity: 0.8 });
  readonly nodeBoxes = new Cells("boxes", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly nodeBalls = new Cells("balls", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly edges = new Cells("edges", { colour: "#ffffff", opacity: 0.9 });
  readonly nodeEdges = new Cells("edges", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly pairs = new Lines({ colour: OKABE_ITO.green, size: 3, depthTest: false, order: 4 });
  readonly candidateFaces = new Faces({ colour: OKABE_ITO.yellow, opacity: 0.85, order: 1 });
  readonly candidates = new Lines({ colour: OKABE_ITO.blue, size: 1.5, depthTest: false, order: 3 });
  readonly triangles = new Faces({ colour: CONTACT, opacity: 0.95, order: 2 });
  readonly points = new Dots({ colour: OKABE_ITO.yellow, order: 6 });
  readonly normals = new Lines({ colour: OKABE_ITO.sky, size: 2, depthTest: false, order: 5 });
  readonly segments = new Lines({ colour: "#ffffff", size: 2.5, depthTest: false, order: 5 });
  readonly proximity = new Cells("edges", { colour: "#ffffff", opacity: 1, order: 5 });
  readonly depths = new Lines({ colour: OKABE_ITO.purple, size: 2.5, depthTest: false, order: 5 });
  readonly curveFaces = new Faces({ colour: OKABE_ITO.green, opacity: 0.5, order: 1 });
  readonly curveArrows = new Lines({ colour: "#ffffff", size: 3.5, depthTest: false, order: 6 });
  readonly curves = new Dots({ colour: "#ffffff", order: 7 });
  readonly vertices = new Dots({ colour: OKABE_ITO.purple, order: 6 });
  private readonly marks = new Marks();

  constructor(private readonly model: Model) {
    for (const layer of this.all()) this.group.add(layer.shape);
    model.on("scene", () => this.marks.fit(model.objects));
  }

  private all() {
    return [
      this.regions, this.boxes, this.balls, this.edges, this.nodeBoxes, this.nodeBalls, this.nodeEdges, this.pairs, this.candidateFaces,
      this.candidates, this.triangles, this.points, this.normals, this.segments, this.proximity, this.depths, this.curveFaces, this.curveArrows, this.curves,
      this.vertices,
    ];
  }

  /** The number of elements that each layer draws. */
  counts(): Record<string, number> {
    const { regions, boxes, balls, edges, nodeBoxes, nodeBalls, nodeEdges, pairs, candidates, candidateFaces, triangles, points, normals, segments, proximity, depths, curveFaces, curveArrows, curves, vertices } = this;
    return Object.fromEntries(
      Object.entries({ regions, boxes, balls, edges, nodeBoxes, nodeBalls, nodeEdges, pairs, candidates, candidateFaces, triangles, points, normals, segments, proximity, depths, curveFaces, curveArrows, curves, vertices })
        .map(([name, layer]) => [name, layer.count]),
    );
  }

  update(): void {
    const { layers } = this.model;
    for (const layer of [this.points, this.vertices, this.segments, this.normals, this.proximity, this.depths, this.curveFaces, this.curveArrows, this.curves, this.nodeBoxes, this.nodeBalls, this.nodeEdges]) layer.depthTest = !this.model.throughSurfaces;
    this.points.size = this.model.pointSize + 2;
    this.vertices.size = this.model.pointSize;
    this.curves.size = this.model.pointSize + 4;
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

  /** Calls `visit` with the offset of each point of contacts or impacts whose objects are both visible. */
  private eachPoint(visit: (data: Float32Array, at: number) => void): void {
    const { frame } = this.model;
    if (!frame) return;
    const { contacts, impacts } = frame;
    for (let i = 0; i < contacts.length; i += 8) {
      if (!this.shown(contacts[i]!) || !this.shown(contacts[i + 2]!)) continue;
      const first = contacts[i + 6]!;
      for (let k = 0; k < contacts[i + 5]!; ++k) visit(frame.contactPoints, 8 * (first + k));
    }
    for (let i = 0; i < impacts.length; i += 8)
      if (this.shown(impacts[i]!) && this.shown(impacts[i + 3]!)) visit(frame.impactPoints, i);
  }

  private pointCount(): number {
    const { frame } = this.model;
    return frame ? (frame.contactPoints.length + frame.impactPoints.length) / 8 : 0;
  }

  private fillPoints(on: boolean): void {
    this.points.fill(on ? this.pointCount() : 0, (into) => {
      let at = 0;
      this.eachPoint((data, from) => {
        into[at++] = data[from]!;
        into[at++] = data[from + 1]!;
        into[at++] = data[from + 2]!;
      });
      return at / 3;
    });
  }

  private fillNormals(on: boolean): void {
    const bounds = this.model.scene?.bounds;
    const size = bounds ? Math.hypot(...bounds[1].map((x, axis) => x - bounds[0][axis]!)) : 1;
    const length = this.model.normalLength * size;
    this.normals.fill(on ? this.pointCount() : 0, (into) => {
      let at = 0;
      this.eachPoint((data, from) => {
        for (let axis = 0; axis < 3; ++axis) into[at++] = data[from + axis]!;
        for (let axis = 0; axis < 3; ++axis) into[at++] = data[from + axis]! + length * data[from + 4 + axis]!;
      });
      return at / 6;
    });
  }

  private fillSegments(on: boolean): void {
    const { frame } = this.model;
    if (!on || !frame) return this.segments.fill(0, () => 0);
    const { contacts, contactPoints } = frame;
    this.segments.fill(contactPoints.length / 8, (into) => {
      let at = 0;
      for (let i = 0; i < contacts.length; i += 8) {
        const count = contacts[i + 5]!;
        if (count < 2 || !this.shown(contacts[i]!) || !this.shown(contacts[i + 2]!)) continue;
        const first = contacts[i + 6]!;
        const lines = count === 2 ? 1 : count;  // a polygon is closed
        for (let k = 0; k < lines; ++k)
          for (const point of [first + k, first + ((k + 1) % count)])
            for (let axis = 0; axis < 3; ++axis) into[at++] = contactPoints[8 * point + axis]!;
      }
      return at / 6;
    });
  }

  /** Lines between closest points, coloured by the share of the margins that the distance takes. */
  private fillProximity(on: boolean): void {
    const { frame } = this.model;
    if (!on || !frame || frame.proximityPairs.length === 0) return this.proximity.fill([]);
    const rows = new Float32Array(frame.proximityPoints.length);
    let at = 0;
    for (let i = 0; i < frame.proximityPairs.length / 2; ++i) {
      if (!this.shown(frame.proximityPairs[2 * i]!) || !this.shown(frame.proximityPairs[2 * i + 1]!)) continue;
      rows.set(frame.proximityPoints.subarray(8 * i, 8 * i + 8), at);
      rows[at + 3] = proximityLevel(frame.proximityPoints[8 * i + 7]!);
      at += 8;
    }
    this.proximity.fill([rows.subarray(0, at)]);
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
