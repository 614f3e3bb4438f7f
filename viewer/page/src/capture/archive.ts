import { Zip, ZipPassThrough } from "fflate";

/** Room is kept for the list of files at the end, of at most this many. */
export const MOST_FILES = 65_000;
const LARGEST = 0xffffffff - 200 * MOST_FILES;

/** A ZIP that grows file by file, without compression: pictures have theirs. What is written waits in blobs, which the browser may keep on disk. */
export class Archive {
  private readonly parts: Blob[] = [];
  private size = 0;
  private readonly zip = new Zip((error, data) => {
    if (error) throw error;
    this.parts.push(new Blob([data as Uint8Array<ArrayBuffer>]));
    this.size += data.length;
  });

  /** Throws when the file has no room any more. */
  async add(name: string, content: Blob): Promise<void> {
    if (this.size + content.size > LARGEST) throw new Error("A ZIP holds 4 GB and is full. Save the rest, from here on, in another one.");
    const data = new Uint8Array(await content.arrayBuffer());
    const file = new ZipPassThrough(name);
    this.zip.add(file);
    file.push(data, true);
  }

  /** The whole ZIP; nothing can be added after that. */
  end(): Blob {
    this.zip.end();
    return new Blob(this.parts, { type: "application/zip" });
  }
}
