import { download, stamp } from "../panels/dom";
import type { SceneView } from "../view/scene_view";

/** Records what is drawn as a WebM video in real time; late frames are dropped. */
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
