import maupScene from '../../../src/report/page/scene.js';
import maupPainter from '../../../src/report/page/painter.js';
import type {View} from '../../../src/report/page/scene.js';
import type {Clock} from '../clock';
import type {Scene, SceneElement} from '../contract';
import type {State} from '../state';
import type {Store} from '../store';
import type {Study} from '../study';
import {Camera, placeUnder} from './camera';

interface Grip {
  element: number;
  point: number;
  place: number[];
}
const reach = {mouse: 18, touch: 30};

/**
 * The drawing in motion. A point is dragged, the empty sheet shifted (in space turned); the wheel or two fingers zoom.
 */
export class Stage {
  readonly camera = new Camera();
  private readonly context: CanvasRenderingContext2D;
  private readonly painter;
  private width = 0;
  private height = 0;
  private bounds: Scene | null = null; // of what is seen: it does not shrink while values change
  private grip: Grip | null = null;
  private hovered: Grip | null = null;
  private moved = false;
  private ended = false;
  private readonly size = new ResizeObserver(() => this.fit());
  private pointers = new Map<number, [number, number]>();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly store: Store<State>,
    private readonly clock: Clock,
    private readonly study: Study | null,
  ) {
    this.context = canvas.getContext('2d')!;
    this.painter = maupPainter(this.context);
    this.painter.readColours();
    this.size.observe(canvas);
    clock.onTick(() => this.draw());
    store.watch(['run', 'pose', 'pins', 'trail', 'forces', 'quick'], () => {
      if (this.ended) return;
      this.bound();
      if (!clock.playing) this.draw(); // else with the next frame, once
    });
    if (study) this.listen();
    canvas.addEventListener('wheel', event => this.wheel(event), {passive: false});
    canvas.addEventListener('dblclick', () => {
      this.camera.reset();
      this.draw();
    });
  }

  recolour(): void {
    this.painter.readColours();
    this.draw();
  }

  /** Its canvas leaves the page. */
  end(): void {
    this.ended = true;
    this.size.disconnect();
  }

  private fit(): void {
    const ratio = window.devicePixelRatio || 1,
      box = this.canvas.getBoundingClientRect();
    if (box.width === 0) return;
    [this.width, this.height] = [box.width, box.height];
    this.canvas.width = Math.round(box.width * ratio);
    this.canvas.height = Math.round(box.height * ratio);
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.draw();
  }

  get scene(): Scene | null {
    return this.store.state.pose ?? this.store.state.run?.drawing ?? null;
  }

  /** All runs that are shown fit; bounds that hardly change stay, so that the picture rests. */
  private bound(): void {
    const {run, pins, quick, pose, forces} = this.store.state,
      scene = run?.drawing && forces === 'all' ? withArrows(run.drawing) : run?.drawing;
    if (!scene) {
      this.bounds = null;
      return;
    }
    if (pose) return;
    const all = [scene, ...pins.filter(pin => pin.shown && pin.run.drawing).map(pin => pin.run.drawing!)];
    const low = scene.low.map((_, k) => Math.min(...all.map(one => one.low[k])));
    const high = scene.high.map((_, k) => Math.max(...all.map(one => one.high[k])));
    const radius = Math.max(...all.map(one => one.radius)),
      before = this.bounds;
    const same = before && before.dimension === scene.dimension;
    const within =
      same && before.low.every((x, k) => low[k] >= x - 1e-9) && before.high.every((x, k) => high[k] <= x + 1e-9);
    if (within && (quick || radius > 0.6 * before.radius)) return;
    const keep = quick && same;
    this.bounds = {
      ...scene,
      low: keep ? low.map((x, k) => Math.min(x, before.low[k])) : low,
      high: keep ? high.map((x, k) => Math.max(x, before.high[k])) : high,
      radius: keep ? Math.max(radius, before.radius) : radius,
    };
  }

  private view(scene: Scene): View {
    const bounds = this.bounds?.dimension === scene.dimension ? this.bounds : scene;
    return this.camera.view(bounds, this.width, this.height);
  }

  draw(): void {
    if (this.width === 0 || this.ended) return;
    this.context.clearRect(0, 0, this.width, this.height);
    const scene = this.scene;
    if (!scene) return;
    const view = this.view(scene),
      {pins, pose, trail, forces} = this.store.state,
      s = pose ? 0 : this.clock.s;
    const hidden = (e: SceneElement): boolean =>
      e.kind === 'arrow' && (forces === 'none' || (forces === 'asked' && e.origin !== undefined));
    const shown = (one: Scene): Scene =>
      one.elements.some(hidden) ? {...one, elements: one.elements.filter(e => !hidden(e))} : one;
    for (const pin of pins)
      if (pin.shown && pin.run.drawing)
        this.painter.paint(
          maupScene.frameItems(shown(pin.run.drawing), view, Math.min(s, maupScene.duration(pin.run.drawing)), {
            trail: 'none',
          }),
          view.unit,
          {opacity: 0.5, only: pin.series},
        );
    const how = pose ? 'none' : ({some: 'fading', bodies: 'fading', all: 'whole', none: 'none'} as const)[trail];
    this.painter.paint(
      maupScene.frameItems(shown(trail === 'bodies' && !pose ? everyTrail(scene) : scene), view, s, {
        trail: how,
        trailTime: 3 * this.clock.rate,
      }),
      view.unit,
    );
    this.painter.paint(maupScene.furniture(scene, view), view.unit);
    this.mark(scene, view, s);
  }

  private mark(scene: Scene, view: View, s: number): void {
    const grip = this.grip ?? this.hovered,
      element = grip && scene.elements[grip.element];
    if (!grip || !element) return;
    const at = placeOf(scene, element, grip.point, s),
      [x, y] = maupScene.project(scene, view, at, maupScene.centreAt(scene, view, s));
    this.context.beginPath();
    this.context.arc(x, y, 13, 0, 2 * Math.PI);
    this.context.strokeStyle = getComputedStyle(this.canvas).getPropertyValue('--accent');
    this.context.lineWidth = 2;
    this.context.stroke();
  }

  // ------------------------------------------------------------------------------------------------------- pointers

  private listen(): void {
    const {canvas} = this;
    canvas.addEventListener('pointerdown', event => this.down(event));
    canvas.addEventListener('pointermove', event => this.move(event));
    for (const end of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(end, event => this.up(event));
    canvas.addEventListener('pointerleave', () => {
      this.hovered = null;
      this.draw();
    });
  }

  private at(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** The point of the drawing next to (x, y) that moves. */
  private pick(x: number, y: number, near: number): Grip | null {
    const scene = this.scene;
    if (!scene) return null;
    const s = this.store.state.pose ? 0 : this.clock.s,
      view = this.view(scene),
      centre = maupScene.centreAt(scene, view, s);
    let best: Grip | null = null,
      least = near;
    scene.elements.forEach((element, i) => {
      if (element.still || (element.kind !== 'path' && element.kind !== 'solid') || element.ground) return;
      const points = element.kind === 'solid' ? 1 : element.points;
      for (let p = 0; p < points; ++p) {
        const place = placeOf(scene, element, p, s),
          at = maupScene.project(scene, view, place, centre);
        const distance =
          Math.hypot(at[0] - x, at[1] - y) - (element.bobs?.[p] ? 4 : 0) + (moves(scene, element, p) ? 0 : 1e6);
        if (distance < least) [least, best] = [distance, {element: i, point: p, place}];
      }
    });
    return best;
  }

  private down(event: PointerEvent): void {
    const [x, y] = this.at(event);
    this.pointers.set(event.pointerId, [x, y]);
    this.canvas.setPointerCapture(event.pointerId);
    if (this.pointers.size > 1) return this.letGo(false);
    this.grip =
      event.button === 0 && !event.altKey
        ? this.pick(x, y, event.pointerType === 'touch' ? reach.touch : reach.mouse)
        : null;
    this.moved = false;
    if (this.grip) this.study?.drags.grab();
    this.draw();
  }

  private move(event: PointerEvent): void {
    const [x, y] = this.at(event),
      before = this.pointers.get(event.pointerId);
    if (!before) {
      const hovered = this.pick(x, y, reach.mouse),
        changed = hovered?.element !== this.hovered?.element || hovered?.point !== this.hovered?.point;
      this.hovered = hovered;
      this.canvas.style.cursor = hovered ? 'grab' : '';
      if (changed) this.draw();
      return;
    }
    const [dx, dy] = [x - before[0], y - before[1]];
    if (this.pointers.size === 2) this.pinch(event.pointerId, x, y);
    else if (this.grip) this.pull(x, y, Math.hypot(dx, dy));
    else if (this.scene?.dimension === 3) this.camera.turn(dx, dy);
    else this.camera.shift = [this.camera.shift[0] + dx, this.camera.shift[1] + dy];
    if (!this.grip || this.moved) this.pointers.set(event.pointerId, [x, y]);
    this.draw();
  }

  private pull(x: number, y: number, distance: number): void {
    if (!this.moved && distance < 3) return;
    this.moved = true;
    const scene = this.scene,
      grip = this.grip;
    if (!scene || !grip) return;
    const s = this.store.state.pose ? 0 : this.clock.s,
      view = this.view(scene);
    const to = placeUnder(scene, view, x, y, grip.place, maupScene.centreAt(scene, view, s));
    this.study?.drags.drag(grip.element, grip.point, to);
  }

  private pinch(id: number, x: number, y: number): void {
    const other = [...this.pointers].find(([key]) => key !== id)![1],
      [bx, by] = this.pointers.get(id)!;
    const before = Math.hypot(bx - other[0], by - other[1]),
      now = Math.hypot(x - other[0], y - other[1]);
    if (before > 0)
      this.camera.zoomAt(now / before, (x + other[0]) / 2, (y + other[1]) / 2, [this.width / 2, this.height / 2]);
  }

  private up(event: PointerEvent): void {
    this.pointers.delete(event.pointerId);
    this.letGo(event.type === 'pointerup' && this.moved);
  }

  private letGo(moved: boolean): void {
    if (!this.grip) return;
    this.grip = null;
    void this.study?.drags.release(moved);
    this.draw();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const [x, y] = this.at(event);
    this.camera.zoomAt(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), x, y, [
      this.width / 2,
      this.height / 2,
    ]);
    this.draw();
  }
}

const widened = new WeakMap<Scene, Scene>();

/** The scene with bounds that hold the arrows of all forces too. */
function withArrows(scene: Scene): Scene {
  const made = widened.get(scene);
  if (made) return made;
  const d = scene.dimension,
    low = [...scene.low],
    high = [...scene.high];
  for (const e of scene.elements) {
    if (e.kind !== 'arrow' || e.origin === undefined) continue;
    for (let i = 0; i < e.positions.length; ++i) {
      const k = i % d,
        frame = Math.floor(i / (e.points * d)),
        x = e.positions[i] - (scene.follow.length ? scene.follow[frame * d + k] : 0);
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  }
  const whole = {...scene, low, high, radius: Math.hypot(...low.map((x, k) => (high[k] - x) / 2)) || 1};
  widened.set(scene, whole);
  return whole;
}

const trailed = new WeakMap<Scene, Scene>();

/** The scene with a trail of every body and every point with mass, in the place of those that the model asks for. */
function everyTrail(scene: Scene): Scene {
  const made = trailed.get(scene);
  if (made) return made;
  const d = scene.dimension;
  const trailOf = (element: SceneElement, point: number): SceneElement => ({
    kind: 'trail',
    points: 1,
    still: false,
    positions: scene.times.flatMap((_, frame) => {
      const at = (frame * element.points + point) * d;
      return element.positions.slice(at, at + d);
    }),
  });
  const trails = scene.elements.flatMap(element => {
    if (element.still || element.ground) return [];
    if (element.kind === 'solid') return [trailOf(element, 0)];
    return element.kind === 'path' ? (element.bobs ?? []).flatMap((bob, p) => (bob ? [trailOf(element, p)] : [])) : [];
  });
  const whole = {...scene, elements: [...trails, ...scene.elements.filter(element => element.kind !== 'trail')]};
  trailed.set(scene, whole);
  return whole;
}

function placeOf(scene: Scene, element: SceneElement, point: number, s: number): number[] {
  return maupScene.pointsAt(scene, element, s).slice(point * scene.dimension, (point + 1) * scene.dimension);
}

/** A pivot in a path does not. */
function moves(scene: Scene, element: SceneElement, point: number): boolean {
  const d = scene.dimension,
    width = element.points * d,
    frames = scene.times.length;
  if (frames < 2) return true;
  for (const frame of [1, frames >> 2, frames >> 1, (3 * frames) >> 2, frames - 1])
    for (let k = 0; k < d; ++k)
      if (
        Math.abs(element.positions[frame * width + point * d + k] - element.positions[point * d + k]) >
        1e-9 * scene.radius
      )
        return true;
  return false;
}
