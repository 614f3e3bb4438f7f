import { Zip, ZipPassThrough } from "fflate";

/** The maximum number of files, because space for the list at the end is reserved. */
export const MOST_FILES = 65_000;
const LARGEST = 0xffffffff - 200 * MOST_FILES;

/**
 * A ZIP that grows file by file. It does not compress, because pictures are already compressed. Written
 * data is kept in blobs, which the browser may keep on disk.
 */
export class Archive {
  private readonly parts: Blob[] = [];
  private size = 0;
  private readonly zip = new Zip((error, data) => {
    if (error) throw error;
    this.parts.push(new Blob([data as Uint8Array<ArrayBuffer>]));
    this.size += data.length;
  });

  /** Throws when the archive is full. */
  async add(name: string, content: Blob): Promise<void> {
    if (this.size + content.size > LARGEST) throw new Error("The ZIP has reached its limit of 4 GB. Save the remaining frames in another one.");
    const data = new Uint8Array(await content.arrayBuffer());
    const file = new ZipPassThrough(name);
    this.zip.add(file);
    file.push(data, true);
  }

  /** Returns the complete ZIP. Nothing can be added afterwards. */
  end(): Blob {
    this.zip.end();
    return new Blob(this.parts, { type: "application/zip" });
  }
}
