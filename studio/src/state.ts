import type {
  Diagnostic,
  EquationsAnswer,
  ModesAnswer,
  OpenAnswer,
  RunAnswer,
  Scene,
  SectionAnswer,
  Section,
  Trouble,
  Conserved,
} from './contract';

/** A run that stays to be compared with. */
export interface Pin {
  id: number;
  label: string;
  series: number;
  run: RunAnswer;
  shown: boolean;
}
export interface ChartSpec {
  columns: string[];
  against: string | null;
}
export type Pane = 'model' | 'values' | 'motion' | 'equations';

/** Where the text came from: a file of the opened folder, or nothing but this page. */
export interface Origin {
  path: string;
  version: string;
  saved: string;
}

export interface State {
  // what is asked
  text: string;
  name: string;
  origin: Origin | null;
  set: Record<string, string>;
  start: Record<string, string>;
  duration: string; // '' as in the text
  mode: string; // of contacts; '' as the motion is
  steps: boolean; // the derivation is wanted
  // what came
  version: string; // of the core
  opened: OpenAnswer | null;
  openedText: string; // the text that `opened` is about
  readable: boolean;
  equations: EquationsAnswer | null;
  equationsTrouble: Trouble | null;
  run: RunAnswer | null;
  runTrouble: Trouble | null;
  quick: boolean; // the run has few frames, a full one comes
  deep: Diagnostic[]; // what only a derivation finds
  modes: ModesAnswer | Trouble | null;
  phaseSpace: Section[] | Trouble | null;
  found: Conserved[] | Trouble | null;
  section: SectionAnswer | null;
  sectionTrouble: Trouble | null;
  pose: Scene | null; // while a point is dragged
  pins: Pin[];
  // how it is shown
  pane: Pane;
  charts: ChartSpec[] | null; // null: what the model asks for
  trail: 'some' | 'bodies' | 'all' | 'none';
  forces: boolean;
  busy: string | null;
  progress: number | null;
  word: {text: string; trouble: boolean} | null;
  storage: boolean;
}

export const initialState: State = {
  text: '',
  name: 'model',
  origin: null,
  set: {},
  start: {},
  duration: '',
  mode: '',
  steps: false,
  version: '',
  opened: null,
  openedText: '',
  readable: false,
  equations: null,
  equationsTrouble: null,
  run: null,
  runTrouble: null,
  quick: false,
  deep: [],
  modes: null,
  phaseSpace: null,
  found: null,
  section: null,
  sectionTrouble: null,
  pose: null,
  pins: [],
  pane: 'motion',
  charts: null,
  trail: 'some',
  forces: true,
  busy: null,
  progress: null,
  word: null,
  storage: true,
};
