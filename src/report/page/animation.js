// The drawings of a report: each figure names the element with its frames, data-drawing. They are drawn on its canvas;
// the reader plays, pauses, scrubs, changes the speed, and turns a drawing in space, as far as the figure has controls.
// A mode (data-loop) swings without end over its equilibrium. Nothing is fetched. What a moment looks like is said by
// scene.js, and painted by painter.js.
'use strict';
function animate(figure, scene) {
  const loops = 'loop' in figure.dataset;
  const canvas = figure.querySelector('canvas'), context = canvas.getContext('2d'), painter = maupPainter(context);
  const control = name => figure.querySelector(`[data-control="${name}"]`);
  const {times, elements} = scene, spatial = scene.dimension === 3;
  for (const element of elements) element.positions = element.positions.map(value => value ?? NaN);
  const duration = maupScene.duration(scene), direction = maupScene.direction(scene);
  const camera = {azimuth: -0.9, elevation: 0.32, furniture: !loops};
  let view = null;

  function fit() {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
    canvas.width = Math.round(box.width * ratio);
    canvas.height = Math.round(box.height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    view = maupScene.makeView(scene, box.width, box.height, camera);
  }
  const turn = () => { view = maupScene.makeView(scene, view.width, view.height, camera); };

  const paint = (items, options) => painter.paint(items, view.unit, options);
  const trail = () => loops ? 'none' : {some: 'fading', all: 'whole', none: 'none'}[control('trail')?.value ?? 'none'];
  function draw() {
    context.clearRect(0, 0, view.width, view.height);
    // A mode passes its equilibrium a quarter of a period after its turning point.
    if (loops) paint(maupScene.frameItems(scene, view, duration / 4, {trail: 'none'}), {opacity: 0.2});
    paint(maupScene.frameItems(scene, view, elapsed, {trail: trail(), trailTime: 3 * rate()}));
    if (!loops) paint(maupScene.furniture(scene, view));
  }

  // ------------------------------------------------------------------------------------------------------- controls

  let elapsed = 0, playing = false, before = 0;
  const now = () => times[0] + direction * elapsed;
  const digits = Math.max(0, Math.min(9, 3 - Math.floor(Math.log10(duration || 1))));
  const rate = () => Number(control('speed')?.value ?? figure.dataset.rate);

  function show() {
    draw();
    const text = `${now().toFixed(digits)}${scene.dimensionless ? '' : ' s'}`;
    if (!loops) {
      control('time').textContent = text;
      control('scrub').value = duration > 0 ? String(elapsed / duration) : '0';
      control('scrub').setAttribute('aria-valuetext', `t = ${text}`);
    }
    control('play')?.setAttribute('aria-label', playing ? 'Pause' : 'Play');
    figure.dataset.time = String(now());
    figure.dataset.state = playing ? 'playing' : 'paused';
  }

  function step(stamp) {
    if (!playing) return;
    elapsed = Math.min(duration, elapsed + Math.min(0.1, (stamp - before) / 1000) * rate());
    before = stamp;
    if (elapsed >= duration) loops ? elapsed = 0 : playing = false;
    show();
    if (playing) requestAnimationFrame(step);
  }

  function play(on) {
    if (on === playing) return;
    playing = on;
    if (playing) {
      if (elapsed >= duration) elapsed = 0;
      before = performance.now();
      requestAnimationFrame(step);
    }
    show();
  }

  function seek(s) {
    elapsed = Math.min(duration, Math.max(0, s));
    show();
  }

  // Speeds around the one at which a run takes a pleasant time to watch.
  function offerSpeeds() {
    const pleasant = duration >= 2 && duration <= 120 ? 1 : 10 ** Math.round(Math.log10(duration / 15 || 1));
    const select = control('speed');
    if (!select) return;
    for (const factor of [0.1, 0.25, 0.5, 1, 2, 5, 10]) {
      const option = document.createElement('option'), speed = pleasant * factor;
      option.value = String(speed);
      option.textContent = '× ' + speedText(Number(speed.toPrecision(2)));
      option.selected = factor === 1;
      select.append(option);
    }
  }

  function speedText(speed) {
    if (speed >= 1e-3 && speed < 1e6) return speed.toLocaleString('en');
    const [mantissa, exponent] = speed.toExponential().split('e');
    const raised = [...exponent.replace('+', '')].map(c => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]).join('');
    return (mantissa === '1' ? '' : mantissa + ' · ') + '10' + raised;
  }

  function onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^(INPUT|SELECT|TEXTAREA|SUMMARY|A)$/.test(event.target.tagName) && event.target !== control('scrub')) return;
    const small = duration / 200, large = duration / 20;
    const actions = {
      ' ': () => play(!playing),
      ArrowRight: () => seek(elapsed + (event.shiftKey ? large : small)),
      ArrowLeft: () => seek(elapsed - (event.shiftKey ? large : small)),
      Home: () => event.target !== document.body && seek(0),
      End: () => event.target !== document.body && seek(duration),
    };
    const action = actions[event.key];
    if (!action || (event.key === ' ' && event.target.tagName === 'BUTTON')) return;
    if (action() === false) return;
    event.preventDefault();
  }

  function turnByPointer() {
    let last = null;
    canvas.addEventListener('pointerdown', event => {
      last = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', event => {
      if (!last) return;
      camera.azimuth -= (event.clientX - last[0]) * 0.01;
      camera.elevation = Math.min(1.57, Math.max(-1.57, camera.elevation + (event.clientY - last[1]) * 0.01));
      last = [event.clientX, event.clientY];
      turn();
      show();
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { last = null; });
    canvas.addEventListener('dblclick', () => {
      Object.assign(camera, {azimuth: -0.9, elevation: 0.32});
      turn();
      show();
    });
  }

  painter.readColours();
  offerSpeeds();
  control('play')?.addEventListener('click', () => play(!playing));
  if (!loops) {
    control('scrub').addEventListener('input', event => { play(false); seek(Number(event.target.value) * duration); });
    control('trail').addEventListener('change', show);
    control('trail').closest('label').hidden = !elements.some(element => element.kind === 'trail');
    document.addEventListener('keydown', onKey);
  }
  if (spatial) {
    figure.classList.add('spatial');
    turnByPointer();
  }
  const redraw = () => { painter.readColours(); fit(); show(); };
  new ResizeObserver(redraw).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  document.addEventListener('maup-theme', redraw);
  redraw();
  if (loops && matchMedia('(prefers-reduced-motion: no-preference)').matches) play(true);
}

for (const figure of document.querySelectorAll('figure[data-drawing]'))
  animate(figure, JSON.parse(document.getElementById(figure.dataset.drawing).textContent));
