/** Assembles the page. */
import { Client, type Status } from "./client";
import { ColourBar } from "./fields/colour_bar";
import { Film } from "./capture/film";
import { FramesRun } from "./capture/frames";
import { embeddedJob, failJob, runJob } from "./capture/job";
import { savePicture } from "./capture/picture";
import { commandsOf } from "./commands";
import { listenToKeys } from "./keyboard";
import { Model, TOOLS, type Tool } from "./model";
import { ComparisonPanel } from "./panels/comparison";
import { ContactTable } from "./panels/tables/contact_table";
import { colourOf, h, iconButton, logo, setIcon } from "./panels/dom";
import { FramesDialog } from "./panels/frames_dialog";
import { helpSheet } from "./panels/help";
import { Hover } from "./panels/hover";
import { Inspector } from "./panels/inspector";
import { NodePairs } from "./panels/node_pairs";
import { cannotDraw, Card, Notices } from "./panels/notices";
import { CurveTable } from "./panels/tables/curve_table";
import { offersOfObject, offersOfTabs } from "./panels/offers";
import { offersOf, Palette } from "./panels/palette";
import { PaneFrames } from "./panels/pane_frames";
import { PinTable } from "./panels/tables/pin_table";
import { Player } from "./panels/player";
import { Program } from "./panels/program";
import { Plots } from "./panels/plots/plots";
import { sayFailure, ScenePanel } from "./panels/scene_panel";
import { Settings } from "./panels/settings";
import { Pace } from "./pace";
import { Pins, type Pin } from "./pins";
import { localStore } from "./storage";
import { Tabs } from "./panels/tabs";
import { Tools } from "./tools";
import { openSocket } from "./transport/socket";
import { hasCargo, openWorker } from "./transport/worker";
import { AXIS_VIEWS, type AxisView } from "./view/camera";
import { layoutOf } from "./view/panes";
import { SceneView } from "./view/scene_view";
import { applyCamera, MOST_STORED, showLooks, showView, viewOf, type ViewState } from "./view_state";
import { firstView } from "./views/first_view";
import { viewOfHash } from "./views/view_file";
import { Views } from "./views/views";

const TOOL_LABELS: Record<Tool, [label: string, key: string]> = {
  select: ["Select", "V"],
  grab: ["Grab and pull", "G"],
  explain: ["Why no contact?", "W"],
};
const THEME = "supple-theme";
/** The view of a scene is stored under this name and its title. */
const VIEW = "supple-view ";

export class App {
  readonly model = new Model();
  readonly carriesLibrary = hasCargo();
  view!: SceneView;
  client!: Client;
  player!: Player;
  tools!: Tools;
  help!: HTMLDialogElement;
  palette!: Palette;
  pins!: Pins;
  readonly notices = new Notices();
  readonly card = new Card(() => this.client.connect(), this.carriesLibrary);
  private scenePanel!: ScenePanel;
  private plots!: Plots;
  private pinTable!: PinTable;
  private framesDialog!: FramesDialog;
  private readonly colourBar = new ColourBar(this.model);
  private readonly film_ = new Film();
  private readonly canvas = h("canvas", { class: "view", tabindex: 0, role: "img", "aria-label": "3D view" });
  private readonly title = h("span", { class: "title" });
  private readonly connection = h("span", { class: "connection", role: "status", "aria-label": "Connection" });
  private readonly orthoButton = iconButton("perspective", "Orthographic", "O", () => this.toggleOrthographic());
  private readonly filmButton = iconButton("film", "Record a video", "Shift+V", () => this.film());
  private drawers: HTMLButtonElement[] = [];
  private readonly toolButtons = new Map<Tool, HTMLButtonElement>();
  private readonly pace = new Pace();
  private tabs!: Tabs;
  private hasDrawn = false;  // a frame of the present scene
  private hasRestored = false;
  /** Set in a page that draws for `supple render`. */
  private readonly job = embeddedJob();
  private linked: Partial<ViewState> | null = null;
  /** The step of the view that the page began with. */
  private moment: number | undefined;
  private views!: Views;

  constructor(private readonly body: HTMLElement) {}

  start(): void {
    this.applyTheme(this.job?.theme ?? localStore(THEME));
    this.body.append(this.canvas, this.colourBar.element, this.card.element, this.notices.element);
    try {
      this.view = new SceneView(this.canvas, this.model);
    } catch (error) {
      this.card.fail("This page cannot draw", cannotDraw(error));
      this.client = new Client(this.model, openSocket, () => null);
      this.fail(cannotDraw(error));
      return;
    }
    this.build();
    this.listen();
    this.paint();
    this.exposeForTests();
    const connect = () => this.client.connect();
    viewOfHash(location.hash).then((view) => (this.linked = view), (error: Error) => this.notices.show(error.message)).then(connect);
  }

  /** Says to the program whose job this page does that it cannot. */
  fail(text: string): void {
    if (!this.job) return;
    this.client.on("status", ({ state }) => state === "connected" && failJob(this.client, text));
    if (this.client.status.state === "connected") void failJob(this.client, text);
    else this.client.connect();
  }

  private build(): void {
    const { model, view } = this;
    this.client = new Client(model, this.carriesLibrary ? openWorker : openSocket, (objects) => view.obstacle(objects));
    const fly = () => view.frameSelection();
    this.pins = new Pins(model, (command) => this.client.send(command), (text) => this.notices.show(text));
    const inspector = new Inspector(model, this.client, this.pins, fly);
    this.scenePanel = new ScenePanel(model, fly);
    this.player = new Player(model, this.client);
    this.tools = new Tools(model, this.client, view, inspector);
    this.tools.onPick = () => this.openTab("Inspect");
    this.plots = new Plots(model, (frame) => this.player.goTo(frame));
    this.pinTable = new PinTable(model, this.pins, (pin) => this.showPin(pin), (step) => this.player.goTo(step));
    this.pins.on("list", (pin) => pin && this.openTab("Pins"));
    const program = new Program(model, this.client, (point, reach) => view.flyTo(point, reach));
    this.framesDialog = new FramesDialog(
      model, view, (plan, signal, progress) => new FramesRun(model, this.client, view, plan, signal, progress).go(), (text) => this.notices.show(text),
    );
    this.views = new Views(model, this.client, { view: () => this.viewState(), apply: (state) => this.applyView(state), say: (text) => this.notices.show(text) });
    this.scenePanel.element.firstElementChild!.after(new ComparisonPanel(model, (frame) => this.player.goTo(frame)).element);
    this.scenePanel.element.append(this.views.element);
    this.tabs = new Tabs({
      Inspect: h("div", {}, inspector.element, new NodePairs(model, this.client).element),
      Contacts: new ContactTable(model, this.pins, (point, reach) => view.flyTo(point, reach)).element,
      Curves: new CurveTable(model, (point, reach) => view.flyTo(point, reach)).element,
      Pins: this.pinTable.element,
      Plots: this.plots.element,
      Settings: h("div", {}, program.element, new Settings(model, this.client).element),
    }, "Details");
    const details = this.tabs.element;
    this.openTab("Contacts");
    this.drawers = [this.drawer("scene", "Scene", this.scenePanel.element), this.drawer("details", "Details", details)];
    const commands = commandsOf(this);
    this.help = helpSheet(commands);
    this.palette = new Palette(model, () => [...offersOf(commands), ...offersOfTabs(this, this.tabs.names)], (object) => offersOfObject(this, object));
    const frames = new PaneFrames(this.canvas, view.panes);
    view.panes.onChange = () => {
      frames.update();
      model.view = view.panes.active.index;
      model.emit("display", null);
      this.showProjection();
    };
    const hover = new Hover(this.canvas, model, view.pointing);
    this.body.classList.toggle("watches", this.client.watches);
    this.body.append(
      this.header(), program.banner, this.scenePanel.element, details, this.player.element, this.help, this.framesDialog.element, this.views.dialog,
      this.palette.element, frames.element, hover.element,
    );
    listenToKeys(commands);
  }

  /** In a narrow window a panel is a drawer that this button opens and closes. */
  private drawer(name: string, label: string, panel: HTMLElement): HTMLButtonElement {
    const button = h("button", { type: "button", class: "drawer", "aria-expanded": "false", "aria-controls": `panel-${name}`, onclick: () => this.openDrawer(this.openedDrawer === name ? "" : name) }, label);
    panel.id = `panel-${name}`;
    panel.tabIndex = -1;
    panel.prepend(h("button", { type: "button", class: "drawer close", "aria-label": `Close ${label}`, onclick: () => this.openDrawer("") }, "Close"));
    return button;
  }

  private get openedDrawer(): string {
    return this.body.dataset["drawer"] ?? "";
  }

  /** Focus follows: into the drawer, and back to its button. */
  private openDrawer(name: string): void {
    const before = this.drawers.find((button) => button.getAttribute("aria-controls") === `panel-${this.openedDrawer}`);
    this.body.dataset["drawer"] = name;
    for (const button of this.drawers) button.setAttribute("aria-expanded", String(button.getAttribute("aria-controls") === `panel-${name}`));
    if (name) document.getElementById(`panel-${name}`)!.focus();
    else before?.focus();
  }

  private header(): HTMLElement {
    const tools = TOOLS.map((tool) => {
      const [label, key] = TOOL_LABELS[tool];
      const button = iconButton(tool, label, key, () => this.model.setTool(tool));
      button.append(h("span", { class: "text" }, label));
      button.setAttribute("role", "radio");
      button.setAttribute("aria-checked", String(tool === this.model.tool));
      this.toolButtons.set(tool, button);
      return button;
    });
    const views = h("select", { "aria-label": "Axis view", title: "Axis view (1 to 6)", onchange: () => this.axisView(views) });
    views.append(h("option", { value: "" }, "View"), ...Object.keys(AXIS_VIEWS).map((name, i) => h("option", { value: name }, `${name} (${i + 1})`)));
    const header = h(
      "header", { class: "top" },
      h("span", { class: "brand" }, logo(), "Supple"), this.title, this.connection, ...this.drawers,
      h("div", { class: "group tools", role: "radiogroup", "aria-label": "Tool" }, ...tools),
      h("div", { class: "group" },
        iconButton("frame", "Frame all", "F", () => this.view.frameAll()), views, this.orthoButton,
        iconButton("panes", "One, two or four views", "Q", () => this.view.nextLayout()),
        iconButton("camera", "Save a picture", "Shift+S", () => this.picture()), this.filmButton,
        iconButton("frames", "Save frames as pictures…", "Shift+P", () => this.frames()),
        iconButton("panels", "Hide or show the panels", "H", () => this.togglePanels()),
        iconButton("theme", "Light or dark", "T", () => this.toggleTheme()),
        iconButton("search", "Command palette", "Ctrl+K", () => this.palette.open()),
        h("button", { type: "button", class: "icon", "aria-label": "Keyboard shortcuts", title: "Keyboard shortcuts (?)", onclick: () => this.help.showModal() }, "?")),
    );
    // After a click the keys belong to the view again. Keys and dialogs keep the focus.
    header.addEventListener("click", (event) => {
      if (event.detail > 0 && (event.target as Element).closest("button:not(.drawer)")) this.canvas.focus({ preventScroll: true });
    });
    return header;
  }

  private openTab(name: string): void {
    this.tabs.show(name);
  }

  private axisView(views: HTMLSelectElement): void {
    if (views.value !== "") this.view.rig.lookAlong(views.value as AxisView);
    views.value = "";
  }

  private listen(): void {
    const { model, view, client } = this;
    client.on("status", (status) => this.showStatus(status));
    client.on("notice", (text) => this.notices.show(text));
    client.on("failure", (failure) => this.notices.show(sayFailure(failure)));
    model.on("scene", (scene) => {
      this.title.textContent = scene.title;
      document.title = `${scene.title} · Supple`;
      this.card.showStatus({ state: "connected" });
      this.notices.warn(scene.warnings);
      if (scene.objects.length === 0) this.notices.show("This scene has no objects.");
      this.hasDrawn = false;
      if (!this.hasRestored) this.restoreView();
    });
    model.on("frame", ({ text }) => {
      this.card.hide();
      this.beginMoment();
      this.pace.add(performance.now(), text.time);
    });
    model.on("tool", (tool) => {
      for (const [name, button] of this.toolButtons) button.setAttribute("aria-checked", String(name === tool));
      this.canvas.dataset["tool"] = tool;
      if (tool === "explain") this.openTab("Inspect");
    });
    model.on("explanation", () => model.explanation && this.openTab("Inspect"));
    view.onLost = (why) => {
      client.send({ do: "pause" });
      this.card.fail("Drawing has failed", why);
    };
    view.onTurn = () => {
      this.player.turn();
      this.tools.turn();
      // The session starts to play at the first credit after the first frame: when that frame has been drawn.
      this.hasDrawn ||= model.frame !== null && view.isUpToDate;
      if (this.hasDrawn || model.frame === null) client.giveCredit();
    };
    for (const type of ["pagehide", "visibilitychange"]) addEventListener(type, () => this.storeView());
    setInterval(() => this.tick(), 250);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.paint());
  }

  private restoreView(): void {
    const { view, step, withCamera } = firstView(localStore(VIEW + this.model.scene!.title), this.linked, (text) => this.notices.show(text));
    this.hasRestored = true;
    this.moment = step;
    // The first frame shall be that of the view: the session has played no step before it has credit.
    if (step !== undefined || this.job) this.client.send({ do: "pause" });
    // The first camera fits the shape of the picture. A size that is too large is an error of the job.
    if (this.job && Math.max(this.job.width, this.job.height) <= this.view.largestSide) this.view.setPicture(this.job);
    if (view) this.applyView(view, withCamera);
  }

  private applyView(view: Partial<ViewState>, withCamera = true): void {
    const { model } = this;
    const { panes } = this.view;
    panes.activate(panes.shown[0]!);
    showView(model, view);
    model.emit("display", null);  // a change of the upward axis turns the camera
    if (withCamera) applyCamera(panes.active.rig, view.camera ?? {});
    if (view.views?.layout) this.view.setLayout(layoutOf(view.views.layout));
    if (view.views?.cameras) panes.placeCameras(view.views.cameras);
    showLooks(model, view);
    model.emit("display", null);
    model.emit("request", null);
    if (view.pins && this.job?.plot !== null) this.pins.restore(view.pins);  // pictures have none, plots have
    this.showProjection();
    if (view.tab) this.openTab(view.tab);
    if (view.panels !== undefined) this.body.classList.toggle("bare", !view.panels);
  }

  /** After the first frame: goes to the step of a link, or does the job of `supple render`. */
  private beginMoment(): void {
    const { moment, job, model, client, view } = this;
    if (model.framesSeen > 1) return;
    if (job) void runJob(job, moment ?? 0, model, client, view, this.pins);
    else if (moment !== undefined) this.views.goTo(moment);
  }

  private viewState(most?: number): ViewState {
    const page = { tab: this.tabs.open, panels: !this.body.classList.contains("bare"), views: this.view.panes.stored, pins: this.pins.stored };
    return viewOf(this.model, this.view.panes.rigs[0]!, page, most);
  }

  private storeView(): void {
    if (this.hasRestored) localStore(VIEW + this.model.scene!.title, JSON.stringify(this.viewState(MOST_STORED)));
  }

  /** Updates that are not needed in every frame. */
  private tick(): void {
    const isPlaying = this.player.playing && this.client.status.state === "connected";
    if (!isPlaying) this.pace.clear();
    const { rate, factor } = this.pace.at(performance.now());
    this.player.showRate(rate, factor);
    this.scenePanel.showCounts(this.view.layers.counts(), this.view.isFlat);
  }

  private showStatus(status: Status): void {
    const words = { connecting: "connecting", connected: this.carriesLibrary ? "in this page" : this.client.watches ? "watching" : "live", ended: "ended" };
    this.connection.textContent = words[status.state];
    this.connection.dataset["state"] = status.state;
    if (status.state === "ended" && this.film_.running) this.film();
    this.card.showStatus(status);
  }

  picture(): void {
    savePicture(this.view).catch((error: Error) => this.notices.show(error.message));
  }

  frames(): void {
    if (this.client.status.state !== "connected" || !this.model.frame) return this.notices.show("There are no frames to save: no session is connected.");
    if (this.film_.running) this.film();
    this.tools.release();
    this.player.pause();
    this.framesDialog.open();
  }

  film(): void {
    if (this.film_.running) this.film_.stop();
    else {
      try {
        this.film_.start(this.view);
      } catch (error) {
        this.notices.show((error as Error).message);
      }
    }
    const on = this.film_.running;
    setIcon(this.filmButton, "film", on ? "Stop the video" : "Record a video", "Shift+V");
    this.filmButton.classList.toggle("recording", on);
  }

  toggleOrthographic(): void {
    this.view.rig.setOrthographic(!this.view.rig.isOrthographic);
    this.showProjection();
  }

  private showProjection(): void {
    const on = this.view.rig.isOrthographic;
    setIcon(this.orthoButton, on ? "ortho" : "perspective", on ? "Perspective" : "Orthographic", "O");
  }

  /** Opens a tab, also where the details are a drawer. */
  showTab(name: string): void {
    this.openTab(name);
    this.body.classList.remove("bare");
    if (this.drawers.some((button) => button.offsetParent !== null)) this.openDrawer("details");
  }

  private showPin({ objects, contact }: Pin): void {
    if (contact) this.model.selectContact(contact);
    else this.model.select({ object: objects[0]!, triangle: null, vertex: null });
    this.view.frameSelection();
  }

  togglePanels(): void {
    this.body.classList.toggle("bare");
  }

  escape(): void {
    if (this.tools.isPulling) return this.tools.release();
    if (this.openedDrawer) return this.openDrawer("");
    if (this.model.tool !== "select") return this.model.setTool("select");
    this.model.clearSelection();
    this.model.setExplained([], null);
  }

  private get isDark(): boolean {
    const chosen = document.documentElement.dataset["theme"];
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  }

  toggleTheme(): void {
    const next = this.isDark ? "light" : "dark";
    this.applyTheme(next);
    localStore(THEME, next);
    this.paint();
  }

  private applyTheme(theme: string | null): void {
    if (theme === "light" || theme === "dark") document.documentElement.dataset["theme"] = theme;
  }

  /** Copies the colours of the theme to elements that style sheets do not reach. */
  private paint(): void {
    this.view.setColours(colourOf("--ground"), colourOf("--ink"), colourOf("--line"));
    this.plots.rebuild();
    this.colourBar.update();
    this.pinTable.rebuild();
  }

  /** For the end-to-end tests only. */
  private exposeForTests(): void {
    const { model, view, client, player } = this;
    Object.assign(window, {
      supple: {
        model, client, pins: this.pins,
        get status() { return client.status; },
        get playing() { return player.playing; },
        counts: () => view.layers.counts(),
        project: (point: number[]) => view.pointing.project(point),
        positionOf: (object: number, vertex: number) => view.highlights.positionOf(object, vertex),
        centroid: (object: number, triangle: number) => view.highlights.centroid(object, triangle),
        pickAt: (x: number, y: number) => view.pointing.pickAt(x, y),
        camera: () => ({ position: view.rig.camera.position.toArray(), target: view.rig.controls.target.toArray(), zoom: view.rig.camera.zoom, orthographic: view.rig.isOrthographic }),
        cameras: () => view.panes.shown.map(({ rig }) => rig.state),
        drawTimes: () => [...view.times],
        drawn: () => view.statistics(),
        get isUpToDate() { return view.isUpToDate; },
        draw: () => view.draw(),
        tick: () => this.tick(),
        /** Acts as if a frame had brought new positions of all objects. */
        touch: () => view.touch(),
        loseContext: () => (view.canvas.getContext("webgl2") as WebGL2RenderingContext).getExtension("WEBGL_lose_context")?.loseContext(),
      },
    });
  }
}
