// The drawings of a report: each figure names the element with its frames, data-drawing. They are drawn on its canvas; the
// reader plays, pauses, scrubs, changes the speed, and turns a drawing in space, as far as the figure has controls. A mode
// (data-loop) swings without end over its equilibrium. Nothing is fetched. What a moment looks like is said by scene.js.
'use strict';
function animate(figure, scene) {
  const loops = 'loop' in figure.dataset;
  const canvas = figure.querySelector('canvas'), context = canvas.getContext('2d');
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
    context.lineCap = context.lineJoin = 'round';
    view = maupScene.makeView(scene, box.width, box.height, camera);
  }
  const turn = () => { view = maupScene.makeView(scene, view.width, view.height, camera); };

  // -------------------------------------------------------------------------------------------------------- painting

  const channels = text => {
    context.fillStyle = '#000';
    context.fillStyle = text;  // any colour of a style sheet, as #rrggbb
    return [1, 3, 5].map(i => parseInt(context.fillStyle.slice(i, i + 2), 16));
  };
  let palette = {};
  function readColours() {
    const colour = name => channels(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
    palette = {ink: colour('--ink'), muted: colour('--muted'), paper: colour('--figure'), series: [1, 2, 3, 4, 5, 6, 7].map(i => colour(`--series-${i}`))};
  }
  const inkOf = colour => colour.ink === 'series' ? palette.series[colour.series] : palette[colour.ink];
  const fillOf = colour => `rgb(${inkOf(colour).map((x, k) => Math.round(palette.paper[k] + colour.strength * (x - palette.paper[k]))).join()})`;

  function paint(items, opacity = 1) {
    for (const item of items) {
      const [x, y] = item.points;
      context.globalAlpha = opacity;
      if (item.kind === 'text') { write(item, x, y); continue; }
      context.beginPath();
      if (item.kind === 'disc') context.arc(x, y, item.radius, 0, 2 * Math.PI);
      else for (let i = 0; i < item.points.length; i += 2) context.lineTo(item.points[i], item.points[i + 1]);
      if (item.closed) context.closePath();
      if (item.fill) {
        context.fillStyle = fillOf(item.fill);
        context.fill();
      }
      if (!item.stroke) continue;
      context.globalAlpha = opacity * item.stroke.strength;
      context.lineCap = item.stroke.strength < 1 ? 'butt' : 'round';  // round ends would show as beads where pieces meet
      context.strokeStyle = `rgb(${inkOf(item.stroke).join()})`;
      context.lineWidth = item.width;
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  function write(item, x, y) {
    const {base, index, upright, dots = 0} = item.text, size = 15 * view.unit;
    const faces = "'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif";
    const large = `${upright ? '' : 'italic '}${size}px ${faces}`, small = `${0.72 * size}px ${faces}`, word = base + '\u0307'.repeat(dots);
    context.font = small;
    const tail = context.measureText(index).width;
    context.font = large;
    const whole = context.measureText(word).width + tail;
    const left = item.align === 'l' ? x : item.align === 'r' ? x - whole : x - whole / 2;
    context.fillStyle = fillOf(item.fill);
    context.textAlign = 'left';
    context.textBaseline = 'alphabetic';
    context.fillText(word, left, y + 0.33 * size);
    context.font = small;
    context.fillText(index, left + whole - tail, y + 0.55 * size);
  }

  const trail = () => loops ? 'none' : {some: 'fading', all: 'whole', none: 'none'}[control('trail')?.value ?? 'none'];
  function draw() {
    context.clearRect(0, 0, view.width, view.height);
    // A mode passes its equilibrium a quarter of a period after its turning point.
    if (loops) paint(maupScene.frameItems(scene, view, duration / 4, {trail: 'none'}), 0.2);
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

  readColours();
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
  const redraw = () => { readColours(); fit(); show(); };
  new ResizeObserver(redraw).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  document.addEventListener('maup-theme', redraw);
  redraw();
  if (loops && matchMedia('(prefers-reduced-motion: no-preference)').matches) play(true);
}

for (const figure of document.querySelectorAll('figure[data-drawing]'))
  animate(figure, JSON.parse(document.getElementById(figure.dataset.drawing).textContent));
