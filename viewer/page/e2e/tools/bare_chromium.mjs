// Starts Chromium as a user does, without an automation library, whose inspector would copy every WebSocket
// message. The script talks to the page through the browser's own pipe; nothing is attached to the page
// while it works.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const ANSWER_MILLISECONDS = 30_000;
const FIND_MILLISECONDS = 50;

/** A page that is still opening has no execution context. */
function noContextYet(error) {
  if (!error.message.includes("execution context")) throw error;
  return false;
}

export class BareChromium {
  constructor(executable, flags, address) {
    this.profile = mkdtempSync(join(tmpdir(), "supple-chromium-"));
    const own = ["--headless", "--no-first-run", "--remote-debugging-pipe", `--user-data-dir=${this.profile}`];
    this.child = spawn(executable, [...own, ...flags, address], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    this.address = address;
    this.ended = new Promise((done) => this.child.on("exit", done));
    this.questions = new Map();
    this.lastId = 0;
    let text = "";
    this.child.stdio[4].setEncoding("utf8").on("data", (part) => {
      const messages = (text + part).split("\0");
      text = messages.pop();
      for (const message of messages) this.take(JSON.parse(message));
    });
  }

  take({ id, error, result }) {
    const question = this.questions.get(id);
    if (!question) return;  // an event
    this.questions.delete(id);
    if (error) question.fail(new Error(error.message));
    else question.done(result);
  }

  call(method, params = {}, sessionId = undefined) {
    const id = ++this.lastId;
    this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((done, fail) => {
      const timer = setTimeout(() => fail(new Error(`Chromium does not answer ${method}`)), ANSWER_MILLISECONDS);
      const end = (then) => (value) => {
        clearTimeout(timer);
        then(value);
      };
      this.questions.set(id, { done: end(done), fail: end(fail) });
    });
  }

  async target() {
    for (let tries = 0; tries < ANSWER_MILLISECONDS / FIND_MILLISECONDS; ++tries) {
      const { targetInfos } = await this.call("Target.getTargets");
      const found = targetInfos.find(({ type, url }) => type === "page" && url.startsWith(this.address.split("#")[0]));
      if (found) return found.targetId;
      await new Promise((done) => setTimeout(done, FIND_MILLISECONDS));
    }
    throw new Error("Chromium does not open the page");
  }

  /**
   * Runs a function in the page and returns its result. Attaches only for this call, without observing the
   * network.
   */
  async evaluate(body, argument) {
    const { sessionId } = await this.call("Target.attachToTarget", { targetId: await this.target(), flatten: true });
    const expression = `(${body})(${JSON.stringify(argument)})`;
    const { result, exceptionDetails } = await this.call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true }, sessionId);
    await this.call("Target.detachFromTarget", { sessionId });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until a function returns a true value in the page. */
  async until(body, argument) {
    for (let tries = 0; tries < ANSWER_MILLISECONDS / FIND_MILLISECONDS; ++tries) {
      if (await this.evaluate(body, argument).catch(noContextYet)) return;
      await new Promise((done) => setTimeout(done, FIND_MILLISECONDS));
    }
    throw new Error(`the page does not come to ${body}`);
  }

  async close() {
    this.call("Browser.close").catch(() => this.child.kill());
    await this.ended;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });  // child processes may exit a little later
  }
}
