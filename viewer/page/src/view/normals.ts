/** Vertex normals for smooth shading. */

interface Surface {
  positions: Float32Array;
  corners: Uint32Array;
  vertices: number;
}

let sums = new Float32Array(0);

/**
 * Writes for each vertex the mean of the unit normals of its triangles, weighted by area, as normalized
 * integers; each vertex has four. The mean is short where the surface has a sharp edge, so the shader can
 * keep that edge. Vertices without an area have 0.
 */
export function writeNormals({ positions: p, corners, vertices }: Surface, into: Int16Array): void {
  if (sums.length < 4 * vertices) sums = new Float32Array(4 * vertices);
  else sums.fill(0, 0, 4 * vertices);
  const s = sums;
  for (let i = 0; i < corners.length; i += 3) {
    const one = corners[i]!, two = corners[i + 1]!, three = corners[i + 2]!;
    const a = 3 * one, b = 3 * two, c = 3 * three;
    const ax = p[a]!, ay = p[a + 1]!, az = p[a + 2]!;
    const ux = p[b]! - ax, uy = p[b + 1]! - ay, uz = p[b + 2]! - az;
    const vx = p[c]! - ax, vy = p[c + 1]! - ay, vz = p[c + 2]! - az;
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const length = Math.sqrt(nx * nx + ny * ny + nz * nz);
    if (!(length < Infinity)) continue;  // a vertex is not finite
    const k = 4 * one, l = 4 * two, m = 4 * three;
    s[k]! += nx; s[k + 1]! += ny; s[k + 2]! += nz; s[k + 3]! += length;
    s[l]! += nx; s[l + 1]! += ny; s[l + 2]! += nz; s[l + 3]! += length;
    s[m]! += nx; s[m + 1]! += ny; s[m + 2]! += nz; s[m + 3]! += length;
  }
  for (let i = 0; i < 4 * vertices; i += 4) {
    const scale = s[i + 3]! > 0 ? 32767 / s[i + 3]! : 0;
    into[i] = s[i]! * scale;
    into[i + 1] = s[i + 1]! * scale;
    into[i + 2] = s[i + 2]! * scale;
  }
}
