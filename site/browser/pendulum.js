// The pendulum of the start page. Until someone takes hold of it, it follows the run that maup simulate computed when
// the site was made (cubics through angles and rates). After that a few lines of Runge-Kutta move it: an
// ornament, and it says so.
const figure = document.getElementById('pendulum'),
  svg = figure.querySelector('svg'),
  says = document.getElementById('pendulum-says');
const button = document.getElementById('pendulum-play'),
  rods = svg.querySelector('.rods'),
  trail = svg.querySelector('.trail');
const bobs = [svg.querySelector('.first'), svg.querySelector('.second')];
const rows = JSON.parse(document.getElementById('pendulum-run').textContent),
  g = 9.81,
  last = rows[rows.length - 1][0];

let time = 0,
  own = false,
  held = -1,
  playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
let state = rows[0].slice(1),
  way = []; // state: θ1, θ1', θ2, θ2'; both lengths and masses are 1

// ------------------------------------------------------------------------------------------------------------- motion

function runAt(t) {
  let i = Math.min(rows.length - 2, Math.floor(t / (last / (rows.length - 1))));
  while (i > 0 && rows[i][0] > t) --i;
  while (i < rows.length - 2 && rows[i + 1][0] < t) ++i;
  const [a, b] = [rows[i], rows[i + 1]],
    h = b[0] - a[0],
    u = (t - a[0]) / h,
    w = 1 - u;
  const value = k =>
    a[k] * (1 + 2 * u) * w * w + b[k] * (3 - 2 * u) * u * u + h * u * w * (a[k + 1] * w - b[k + 1] * u);
  const rate = k => a[k + 1] * w + b[k + 1] * u;
  return [value(1), rate(1), value(3), rate(3)];
}

// M q'' + h = 0, solved by Cramer's rule.
function derivative([p, v, q, w]) {
  const c = Math.cos(p - q),
    s = Math.sin(p - q),
    f = -s * w * w - 2 * g * Math.sin(p),
    h = s * v * v - g * Math.sin(q),
    det = 2 - c * c;
  return [v, (f - c * h) / det, w, (2 * h - c * f) / det];
}

function step(y, h) {
  const add = (k, by) => y.map((value, i) => value + by * k[i]);
  const a = derivative(y),
    b = derivative(add(a, h / 2)),
    c = derivative(add(b, h / 2)),
    d = derivative(add(c, h));
  return y.map((value, i) => value + (h / 6) * (a[i] + 2 * b[i] + 2 * c[i] + d[i]));
}

function advance(seconds) {
  if (held >= 0) return;
  if (own) {
    const steps = Math.max(1, Math.ceil(seconds / 0.001));
    for (let i = 0; i < steps; ++i) state = step(state, seconds / steps);
  } else {
    time += seconds;
    if (time >= last) {
      time = 0;
      way = [];
    }
    state = runAt(time);
  }
}

// ------------------------------------------------------------------------------------------------------------ picture

const tips = ([p, , q]) => {
  const x = Math.sin(p),
    y = Math.cos(p);
  return [x, y, x + Math.sin(q), y + Math.cos(q)];
};

function show() {
  const [x, y, u, v] = tips(state);
  rods.setAttribute('d', `M0 0L${x.toFixed(4)} ${y.toFixed(4)}L${u.toFixed(4)} ${v.toFixed(4)}`);
  bobs.forEach((bob, i) => {
    bob.setAttribute('cx', i ? u : x);
    bob.setAttribute('cy', i ? v : y);
    const degrees = Math.round((Math.atan2(Math.sin(state[2 * i]), Math.cos(state[2 * i])) * 180) / Math.PI);
    if (!playing || held >= 0) bob.setAttribute('aria-valuenow', String(degrees));
  });
  if (playing && held < 0) way.push([u, v]);
  if (way.length > 150) way.shift();
  const parts = 6,
    size = Math.ceil(way.length / parts);
  while (trail.children.length < parts) trail.append(document.createElementNS('http://www.w3.org/2000/svg', 'path'));
  [...trail.children].forEach((path, i) => {
    const piece = way.slice(i * size, (i + 1) * size + 1);
    path.setAttribute(
      'd',
      piece.length > 1 ? `M${piece.map(p => `${p[0].toFixed(3)} ${p[1].toFixed(3)}`).join('L')}` : '',
    );
    path.style.opacity = (i + 1) / parts;
  });
}

let before = null;
function frame(now) {
  if (before !== null && playing) advance(Math.min(0.05, (now - before) / 1000));
  before = now;
  show();
  if (playing || held >= 0) requestAnimationFrame(frame);
  else before = null;
}

function play(on) {
  const stood = !playing;
  playing = on;
  button.textContent = on ? 'Pause' : 'Play';
  if (on && stood) requestAnimationFrame(frame);
  if (!on) show();
}

// ------------------------------------------------------------------------------------------------------------- hands

function take() {
  way = [];
  if (own) return;
  own = true;
  says.textContent = 'From here on this page computes it, by a few lines of Runge-Kutta, for the eye alone.';
}

function place(event) {
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  const from = held === 1 ? [Math.sin(state[0]), Math.cos(state[0])] : [0, 0],
    angle = Math.atan2(point.x - from[0], point.y - from[1]);
  state = state.map((value, i) => (i === 2 * held ? angle : i % 2 ? 0 : value));
  show();
}

bobs.forEach((bob, i) => {
  bob.addEventListener('pointerdown', event => {
    take();
    held = i;
    bob.setPointerCapture(event.pointerId);
    svg.classList.add('held');
    place(event);
    event.preventDefault();
  });
  bob.addEventListener('pointermove', event => {
    if (held === i) place(event);
  });
  for (const end of ['pointerup', 'pointercancel'])
    bob.addEventListener(end, () => {
      if (held !== i) return;
      held = -1;
      svg.classList.remove('held');
      play(true);
    });
  bob.addEventListener('keydown', event => {
    const turn = {ArrowRight: 5, ArrowUp: 5, ArrowLeft: -5, ArrowDown: -5, PageUp: 30, PageDown: -30}[event.key];
    if (!turn) return;
    event.preventDefault();
    take();
    play(false);
    state = state.map((value, k) => (k === 2 * i ? value + (turn * Math.PI) / 180 : k % 2 ? 0 : value));
    show();
  });
});
button.addEventListener('click', () => play(!playing));

if (!playing) button.textContent = 'Play';
self.maupPendulum = {
  get state() {
    return [...state];
  },
  get own() {
    return own;
  },
  step,
};
show();
if (playing) requestAnimationFrame(frame);
