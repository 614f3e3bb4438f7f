/** Writes the resolution of a picture into its PNG file. */

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, i) => {
  let value = i;
  for (let bit = 0; bit < 8; ++bit) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  return value;
});
const crcOf = (bytes: Uint8Array): number => ~bytes.reduce((crc, byte) => CRC_TABLE[(crc ^ byte) & 255]! ^ (crc >>> 8), -1) >>> 0;

/** The signature and the header, which is always the first chunk. */
const HEADER_LENGTH = 8 + 25;
const METRES_PER_INCH = 0.0254;

/** The chunk `pHYs`: pixels per metre in both directions. */
export function resolutionChunk(dpi: number): Uint8Array<ArrayBuffer> {
  const chunk = new Uint8Array(21);
  const view = new DataView(chunk.buffer);
  const perMetre = Math.round(dpi / METRES_PER_INCH);
  view.setUint32(0, 9);
  chunk.set(new TextEncoder().encode("pHYs"), 4);
  view.setUint32(8, perMetre);
  view.setUint32(12, perMetre);
  view.setUint8(16, 1);  // the unit is the metre
  view.setUint32(17, crcOf(chunk.subarray(4, 17)));
  return chunk;
}

export function withResolution(png: Blob, dpi: number): Blob {
  return new Blob([png.slice(0, HEADER_LENGTH), resolutionChunk(dpi), png.slice(HEADER_LENGTH)], { type: "image/png" });
}
