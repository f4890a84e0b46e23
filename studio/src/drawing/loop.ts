import maupScene from '../../../src/report/page/scene.js';
import maupPainter from '../../../src/report/page/painter.js';
import type {Scene} from '../contract';
import {h} from '../dom';
import {pretty} from '../panels/words';

/** A mode that swings over its equilibrium while it is on the screen; a click halts it. */
export function loopDrawing(scene: Scene, caption: string): {element: HTMLElement; stop: () => void} {
  const canvas = h('canvas', {role: 'img', 'aria-label': `Mode: ${caption.replaceAll('`', '')}`}),
    context = canvas.getContext('2d')!,
    painter = maupPainter(context);
  const button = h(
    'button',
    {type: 'button', class: 'watch', 'aria-pressed': 'true', onclick: () => set(!playing)},
    'Halt',
  );
  const element = h(
    'figure',
    {class: 'mode'},
    canvas,
    h('figcaption', {}, pretty(caption.replaceAll('`', ''))),
    button,
  );
  const duration = maupScene.duration(scene);
  let playing = false,
    ended = false,
    s = 0,
    before = 0;

  function draw(): void {
    const box = canvas.getBoundingClientRect(),
      ratio = window.devicePixelRatio || 1;
    if (box.width === 0) return;
    if (canvas.width !== Math.round(box.width * ratio)) {
      canvas.width = Math.round(box.width * ratio);
      canvas.height = Math.round(box.height * ratio);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, box.width, box.height);
    painter.readColours();
    const view = maupScene.makeView(scene, box.width, box.height, {azimuth: -0.9, elevation: 0.32, furniture: false});
    // its equilibrium
    painter.paint(maupScene.frameItems(scene, view, duration / 4, {trail: 'none'}), view.unit, {opacity: 0.2});
    painter.paint(maupScene.frameItems(scene, view, s, {trail: 'none'}), view.unit);
  }

  function step(stamp: number): void {
    if (!playing || ended) return;
    s = (s + (Math.min(0.1, Math.max(0, stamp - before) / 1000) * duration) / 2.4) % duration;
    before = stamp;
    draw();
    requestAnimationFrame(step);
  }

  function set(on: boolean): void {
    if (on === playing) return;
    playing = on;
    button.textContent = on ? 'Halt' : 'Watch';
    button.setAttribute('aria-pressed', String(on));
    before = performance.now();
    if (on) requestAnimationFrame(step);
  }

  const seen = new IntersectionObserver(entries => {
    draw();
    const visible = entries.some(entry => entry.isIntersecting);
    if (!visible) set(false);
    else if (matchMedia('(prefers-reduced-motion: no-preference)').matches) set(true);
  });
  seen.observe(canvas);
  return {
    element,
    stop: () => {
      ended = true;
      seen.disconnect();
    },
  };
}
