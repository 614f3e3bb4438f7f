import * as THREE from "three";

/**
 * An interleaved vertex buffer that is filled anew each frame: its array grows by doubling and is written in
 * place. `parts` are the attributes that look into it, by name: how many numbers from which place.
 */
export class Stream {
  array: Float32Array;
  private buffer!: THREE.InterleavedBuffer;

  constructor(
    private readonly geometry: THREE.BufferGeometry,
    private readonly stride: number,
    private readonly parts: Record<string, [size: number, offset: number]>,
    private readonly instanced: boolean,
  ) {
    this.array = new Float32Array(64 * stride);
    this.makeBuffer();
  }

  /** Room for so many elements; what was there may be lost. */
  reserve(count: number): Float32Array {
    const needed = count * this.stride;
    if (this.array.length < needed) {
      this.array = new Float32Array(Math.max(needed, 2 * this.array.length));
      this.makeBuffer();
    }
    return this.array;
  }

  /** So many elements of the array are to be drawn. */
  commit(count: number): void {
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, count * this.stride);
    this.buffer.needsUpdate = true;
    if (this.geometry instanceof THREE.InstancedBufferGeometry) this.geometry.instanceCount = count;
    else this.geometry.setDrawRange(0, count);
  }

  private makeBuffer(): void {
    this.geometry.dispose();  // lets go of the smaller buffer on the GPU
    this.buffer = this.instanced
      ? new THREE.InstancedInterleavedBuffer(this.array, this.stride)
      : new THREE.InterleavedBuffer(this.array, this.stride);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    for (const [name, [size, offset]] of Object.entries(this.parts))
      this.geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, size, offset));
  }
}
