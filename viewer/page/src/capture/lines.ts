/** Edges of meshes, and which parts of lines are visible: a depth buffer on the processor. */

/** Where the surface turns by more than this, its edge is drawn. */
const CREASE_DEGREES = 40;
/** Relative to the depth buffer's own error: a line on a surface is in front of it. */
const DEPTH_SLACK = 1e-5;

/** Vertices on the screen: x, y in pixels and z, the depth that is linear on the screen; NaN when not in front of the camera. */
export type Projected = Float32Array;

/** A matrix of column vectors, as WebGL has it. */
export function project(positions: ArrayLike<number>, matrix: ArrayLike<number>, width: number, height: number): Projected {
  const into = new Float32Array(positions.length);
  const m = matrix as number[];
  for (let i = 0; i < positions.length; i += 3) {
    const [x, y, z] = [positions[i]!, positions[i + 1]!, positions[i + 2]!];
    const w = m[3]! * x + m[7]! * y + m[11]! * z + m[15]!;
    const depth = (m[2]! * x + m[6]! * y + m[10]! * z + m[14]!) / w;
    const isInFront = w > 0 && depth >= -1;
    into[i] = isInFront ? (0.5 + (0.5 * (m[0]! * x + m[4]! * y + m[8]! * z + m[12]!)) / w) * width : NaN;
    into[i + 1] = isInFront ? (0.5 - (0.5 * (m[1]! * x + m[5]! * y + m[9]! * z + m[13]!)) / w) * height : NaN;
    into[i + 2] = isInFront ? depth : NaN;
  }
  return into;
}

/** Each edge once: two vertices, and one or two of its triangles (−1 for none). */
export function edgesOf(corners: Uint32Array): Int32Array {
  const found = new Map<number, number>();  // from both vertices to the place in the list
  const list: number[] = [];
  const most = corners.reduce((largest, vertex) => Math.max(largest, vertex), 0) + 1;
  for (let i = 0; i < corners.length; i += 3)
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [corners[i + k]!, corners[i + ((k + 1) % 3)]!];
      if (a === b) continue;  // an edge or a point of no triangle repeats a vertex
      const key = Math.min(a, b) * most + Math.max(a, b);
      const at = found.get(key);
      if (at === undefined) {
        found.set(key, list.length);
        list.push(a, b, i / 3, -1);
      } else if (list[at + 3] === -1 && list[at + 2] !== i / 3) list[at + 3] = i / 3;
    }
  return Int32Array.from(list);
}

function normalOf(positions: ArrayLike<number>, corners: Uint32Array, triangle: number): [number, number, number] {
  const [a, b, c] = [0, 1, 2].map((k) => 3 * corners[3 * triangle + k]!) as [number, number, number];
  const u = [0, 1, 2].map((axis) => positions[b + axis]! - positions[a + axis]!) as [number, number, number];
  const v = [0, 1, 2].map((axis) => positions[c + axis]! - positions[a + axis]!) as [number, number, number];
  const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as [number, number, number];
  const length = Math.hypot(...normal) || 1;
  return [normal[0] / length, normal[1] / length, normal[2] / length];
}

/** Twice the area on the screen; the sign is the side that one sees. */
const areaOf = (at: Projected, a: number, b: number, c: number): number =>
  (at[3 * b]! - at[3 * a]!) * (at[3 * c + 1]! - at[3 * a + 1]!) - (at[3 * b + 1]! - at[3 * a + 1]!) * (at[3 * c]! - at[3 * a]!);

/** The edges that an outline has: borders, creases, and edges between a front and a back side. */
export function outlineOf(edges: Int32Array, positions: ArrayLike<number>, corners: Uint32Array, at: Projected): Int32Array {
  const least = Math.cos((CREASE_DEGREES * Math.PI) / 180);
  const side = (triangle: number) => Math.sign(areaOf(at, corners[3 * triangle]!, corners[3 * triangle + 1]!, corners[3 * triangle + 2]!));
  const kept: number[] = [];
  for (let i = 0; i < edges.length; i += 4) {
    const [a, b, one, other] = [edges[i]!, edges[i + 1]!, edges[i + 2]!, edges[i + 3]!];
    const isOutline = () => {
      if (other < 0 || side(one) !== side(other)) return true;
      const [n, m] = [normalOf(positions, corners, one), normalOf(positions, corners, other)];
      return n[0] * m[0] + n[1] * m[1] + n[2] * m[2] < least;
    };
    if (isOutline()) kept.push(a, b, one, other);
  }
  return Int32Array.from(kept);
}

/** The depths of the nearest surfaces, one for each pixel. */
export class DepthBuffer {
  private readonly depths: Float32Array;

  constructor(readonly width: number, readonly height: number) {
    this.depths = new Float32Array(width * height).fill(Infinity);
  }

  /** Adds triangles. `scale` turns coordinates of the screen to pixels of this buffer. */
  add(at: Projected, corners: Uint32Array, scale: number): void {
    for (let i = 0; i < corners.length; i += 3) {
      const [a, b, c] = [3 * corners[i]!, 3 * corners[i + 1]!, 3 * corners[i + 2]!];
      this.fill([at[a]! * scale, at[a + 1]! * scale, at[a + 2]!], [at[b]! * scale, at[b + 1]! * scale, at[b + 2]!], [at[c]! * scale, at[c + 1]! * scale, at[c + 2]!]);
    }
  }

  private fill(a: number[], b: number[], c: number[]): void {
    const area = (b[0]! - a[0]!) * (c[1]! - a[1]!) - (b[1]! - a[1]!) * (c[0]! - a[0]!);
    if (!(Math.abs(area) > 0)) return;  // also NaN
    const first = Math.max(0, Math.ceil(Math.min(a[1]!, b[1]!, c[1]!) - 0.5));
    const last = Math.min(this.height - 1, Math.floor(Math.max(a[1]!, b[1]!, c[1]!) - 0.5));
    const left = Math.max(0, Math.ceil(Math.min(a[0]!, b[0]!, c[0]!) - 0.5));
    const right = Math.min(this.width - 1, Math.floor(Math.max(a[0]!, b[0]!, c[0]!) - 0.5));
    for (let y = first; y <= last; ++y)
      for (let x = left; x <= right; ++x) {
        const [px, py] = [x + 0.5, y + 0.5];
        const u = ((b[0]! - px) * (c[1]! - py) - (b[1]! - py) * (c[0]! - px)) / area;
        const v = ((c[0]! - px) * (a[1]! - py) - (c[1]! - py) * (a[0]! - px)) / area;
        const w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        const depth = u * a[2]! + v * b[2]! + w * c[2]!;
        const place = y * this.width + x;
        if (depth < this.depths[place]!) this.depths[place] = depth;
      }
  }

  /** Whether a surface hides a point: it is behind all surfaces within a pixel. */
  hides(x: number, y: number, depth: number): boolean {
    const [column, row] = [Math.floor(x), Math.floor(y)];
    let farthest = -Infinity;
    for (let dy = -1; dy <= 1; ++dy)
      for (let dx = -1; dx <= 1; ++dx) {
        const [i, j] = [column + dx, row + dy];
        if (i < 0 || j < 0 || i >= this.width || j >= this.height) return false;
        farthest = Math.max(farthest, this.depths[j * this.width + i]!);
      }
    return depth > farthest + DEPTH_SLACK;
  }
}

type End = [x: number, y: number, depth: number];

/** The visible parts of a line: [x, y, x, y] each. Without a buffer, nothing hides it. */
export function visibleParts(from: End, to: End, buffer: DepthBuffer | null, scale: number): [number, number, number, number][] {
  if (![...from, ...to].every(Number.isFinite)) return [];
  if (!buffer) return [[from[0], from[1], to[0], to[1]]];
  const steps = Math.min(10_000, Math.max(1, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) * scale)));
  const at = (t: number): End => [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]), from[2] + t * (to[2] - from[2])];
  const parts: [number, number, number, number][] = [];
  let begin: number | null = null;
  for (let i = 0; i <= steps; ++i) {
    const [x, y, depth] = at((Math.min(i, steps - 1) + 0.5) / steps);
    const isVisible = i < steps && !buffer.hides(x * scale, y * scale, depth);
    if (isVisible) begin ??= i;
    else if (begin !== null) {
      const [a, b] = [at(begin / steps), at(i / steps)];
      parts.push([a[0], a[1], b[0], b[1]]);
      begin = null;
    }
  }
  return parts;
}
