import type {Clock} from './clock';
import type {PoseAnswer, Scene, Values} from './contract';
import {nearestRow, withUnit} from './runs';
import type {Study} from './study';

interface Grip {
  values: Values;
  start: Record<string, string>;
  velocities: Record<string, number>; // SI, before the drag: each place of it begins with these
  moved: boolean;
  told: boolean;
}

const tooFar = 'The constraints could not be solved in time for this place. Move more slowly, or less far.';

/** A body that is taken hold of: the mechanism follows it, and the motion begins where it is let go. */
export class Drags {
  private held: Grip | null = null;
  private pulled: Promise<void> = Promise.resolve(); // to the place that was asked for last

  constructor(
    private readonly study: Study,
    private readonly clock: Clock,
  ) {}

  get holding(): boolean {
    return this.held !== null;
  }
  letGo(): void {
    this.held = null;
  }

  /**
   * Takes hold of the system at the moment that is shown. At its start it keeps its velocities; in flight it is held
   * still.
   */
  grab(): void {
    const {run, equations, start: given} = this.study.store.state,
      {s} = this.clock;
    const start = {...given},
      velocities: Record<string, number> = {};
    for (const c of equations?.coordinates ?? []) {
      const v = s > 0 ? 0 : run?.start[c.name + "'"];
      if (typeof v === 'number') velocities[c.name + "'"] = v;
    }
    if (run && equations && s > 0) {
      const row = nearestRow(run, s);
      for (const c of equations.coordinates) {
        const column = run.columns.findIndex(other => other.name === c.name),
          value = column < 0 ? null : run.values[column][row];
        if (value === null) continue;
        start[c.name] = withUnit(value, c.unit);
        start[c.name + "'"] = withUnit(0, c.velocity_unit);
      }
    }
    this.clock.play(false);
    this.held = {values: this.study.values, start, velocities, moved: false, told: false};
  }

  /** Of several places on their way the newest alone is answered. */
  drag(element: number, point: number, to: number[]): void {
    this.pulled = this.pull(element, point, to);
  }

  private async pull(element: number, point: number, to: number[]): Promise<void> {
    const {held, study} = this;
    if (!held) return;
    const answer = await study.asker.ask<PoseAnswer>({
      do: 'pose',
      budget: 2,
      drag: {element, point, to, velocities: held.velocities},
      ...held.values,
      start: held.start,
    });
    if (this.held !== held) return;
    if (!answer.ok) {
      if (answer.kind === 'cancelled' || held.told) return;
      held.told = true;
      return study.say(answer.kind === 'budget' ? tooFar : `${answer.trouble.message} ${answer.trouble.help}`, true);
    }
    this.take(held, answer);
    study.store.update({pose: posed(answer.drawing, study.store.state.run?.drawing ?? null)});
  }

  private take(held: Grip, answer: PoseAnswer): void {
    const {equations, run} = this.study.store.state;
    for (const c of equations?.coordinates ?? []) {
      const q = answer.start[c.name],
        v = answer.start[c.name + "'"],
        before = held.start[c.name] === undefined ? run?.start[c.name] : Number.parseFloat(held.start[c.name]);
      held.moved ||= typeof q === 'number' && q !== before;
      if (q !== null && q !== undefined) held.start[c.name] = withUnit(q, c.unit);
      if (v !== null && v !== undefined) held.start[c.name + "'"] = withUnit(v, c.velocity_unit);
    }
  }

  /** Where it is let go the motion begins: at the last place that was asked for, whose answer may be on its way. */
  async release(moved: boolean): Promise<void> {
    const {held, study} = this;
    if (held && moved) await this.pulled;
    if (this.held !== held) return;
    this.held = null;
    if (!held || !moved) return study.store.update({pose: null});
    if (!held.moved) {
      study.say('Its constraints hold it where it is.');
      return study.store.update({pose: null});
    }
    this.clock.seek(0);
    if (!(await study.beginAt(held.start))) return;
    study.store.update({pose: null});
    if (!study.store.state.runTrouble) this.clock.play(true);
  }
}

/** The moment as the run draws it: sizes of bobs and of the ground come from a whole motion. */
function posed(pose: Scene | null, run: Scene | null): Scene | null {
  if (!pose) return null;
  for (const one of pose.elements) one.positions = one.positions.map(value => value ?? NaN);
  const alike =
    run &&
    run.elements.length === pose.elements.length &&
    run.elements.every((one, i) => one.kind === pose.elements[i].kind && one.points === pose.elements[i].points);
  if (!alike) return pose;
  const elements = run.elements.map((one, i) =>
    one.still && pose.elements[i].still
      ? one
      : {...one, still: pose.elements[i].still, positions: pose.elements[i].positions},
  );
  return {...run, times: [0], follow: pose.follow, elements};
}
