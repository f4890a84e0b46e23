import type {Conserved, ModesAnswer, PathsAnswer, Request, Section, SectionAnswer, Trouble} from './contract';
import type {State} from './state';
import type {Study} from './study';

/** What is looked for when a user asks: it takes its time, and is of the values that stand there then. */
export class Searches {
  private pending = new Map<string, number>(); // on their way, of `changes` of the study

  constructor(private readonly study: Study) {}

  modes(): Promise<void> {
    return this.search<ModesAnswer>({do: 'modes'}, modes => {
      if ('points' in modes)
        for (const shape of modes.points.flatMap(point => point.shapes))
          for (const element of shape.drawing?.elements ?? [])
            element.positions = element.positions.map(value => value ?? NaN);
      return {modes};
    });
  }
  phaseSpace(): Promise<void> {
    return this.search<{sections: Section[]}>({do: 'phase_space'}, answer => ({
      phaseSpace: 'sections' in answer ? answer.sections : answer,
    }));
  }
  paths(): Promise<void> {
    return this.search<PathsAnswer>({do: 'paths', budget: 20}, paths => ({paths}));
  }
  conserved(): Promise<void> {
    return this.search<{conserved: Conserved[]}>({do: 'conserved', budget: 60}, answer => ({
      found: 'conserved' in answer ? answer.conserved : answer,
    }));
  }

  /** It is asked for once. */
  private async search<T extends object>(
    request: Request,
    patch: (answer: T | Trouble) => Partial<State>,
  ): Promise<void> {
    const {study} = this,
      {changes} = study;
    if (this.pending.get(request.do) === changes) return;
    this.pending.set(request.do, changes);
    const answer = await study.asker.ask<T>({...request, ...study.values});
    if (changes !== study.changes) return;
    this.pending.delete(request.do);
    if (answer.ok) study.store.update(patch(answer));
    else if (answer.kind !== 'cancelled') study.store.update(patch(answer.trouble));
  }

  /** The section grows while it is computed. */
  async section(at: string, crossings: number): Promise<void> {
    const {study} = this,
      {changes} = study;
    study.store.update({section: null, sectionTrouble: null, sectionGone: false});
    const answer = await study.asker.ask<SectionAnswer>(
      {do: 'section', at, crossings, budget: 60, ...study.values},
      {
        onMessage: message => {
          if (message.section && changes === study.changes) study.store.update({section: message.section});
        },
      },
    );
    if (changes !== study.changes) return;
    if (answer.ok) study.store.update({section: answer});
    else if (answer.kind !== 'cancelled') study.store.update({sectionTrouble: answer.trouble});
  }
}
