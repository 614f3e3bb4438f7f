/** Pictures and videos of the 3D view. */
import { download } from "./panels/dom";
import type { SceneView } from "./view/scene_view";

const stamp = (): string => new Date().toISOString().slice(0, 19).replace(/[:T]/g, "-");

export function savePicture(view: SceneView): void {
  view.draw();  // the browser keeps the canvas only until the end of this turn
  view.canvas.toBlob((blob) => blob && download(blob, `supple-${stamp()}.png`), "image/png");
}

/** A WebM film of what is drawn, until it is stopped. */
export class Film {
  private recorder: MediaRecorder | null = null;

  get running(): boolean {
    return this.recorder !== null;
  }

  start(view: SceneView): void {
    const wanted = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
    const type = wanted.find((candidate) => MediaRecorder.isTypeSupported(candidate));
    if (!type) throw new Error("This browser cannot record a video.");
    const parts: Blob[] = [];
    const recorder = new MediaRecorder(view.canvas.captureStream(60), { mimeType: type, videoBitsPerSecond: 16_000_000 });
    recorder.ondataavailable = (event) => parts.push(event.data);
    recorder.onstop = () => download(new Blob(parts, { type }), `supple-${stamp()}.${type.startsWith("video/mp4") ? "mp4" : "webm"}`);
    recorder.start(1000);
    view.invalidate();
    this.recorder = recorder;
  }

  stop(): void {
    this.recorder?.stop();
    this.recorder = null;
  }
}
