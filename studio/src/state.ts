import type {
  Diagnostic,
  EquationsAnswer,
  ModesAnswer,
  PathsAnswer,
  OpenAnswer,
  RunAnswer,
  Scene,
  SectionAnswer,
  Section,
  Trouble,
  Conserved,
} from './contract';
import type {Ends} from './lines';

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

/** The file of the opened folder that the text came from. */
export interface Origin {
  path: string;
  version: string;
}

export interface State {
  // what is asked
  text: string; // its lines end with \n
  ends: Ends; // of the lines of its file
  saved: string; // the text as it was loaded, or saved last
  loads: number; // how many models were loaded: each begins anew
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
  equationsText: string; // the text that `equations` are of
  run: RunAnswer | null;
  runText: string; // the text that `run` is of
  runTrouble: Trouble | null;
  quick: boolean; // the run has few frames, a full one comes
  answered: boolean; // the full run, or why there is none, is that of the text and the values
  runLate: boolean; // the run is of a former text or former values: its successor takes long, or failed
  equationsLate: boolean; // so are the equations, of a former text
  slow: boolean; // a quick run did not come in its time
  deep: Diagnostic[]; // what only a derivation finds
  modes: ModesAnswer | Trouble | null;
  phaseSpace: Section[] | Trouble | null;
  paths: PathsAnswer | Trouble | null; // between the ends of the model
  found: Conserved[] | Trouble | null;
  section: SectionAnswer | null;
  sectionTrouble: Trouble | null;
  sectionGone: boolean; // a section was of former values
  pose: Scene | null; // while a point is dragged
  pins: Pin[];
  // how it is shown
  pane: Pane;
  charts: ChartSpec[] | null; // null: what the model asks for
  trail: 'some' | 'bodies' | 'all' | 'none';
  forces: 'asked' | 'all' | 'none';
  busy: string | null;
  progress: number | null;
  word: {text: string; trouble: boolean} | null;
  storage: boolean;
}

/** What stands in the page is of an older text, as this one has a mistake, and not as nobody answers. */
export const hasMistake = ({opened, readable}: State): boolean => opened !== null && !readable && !opened.readable;

export const noDuration = 'E0701',
  heldIntegral = 'E0244';

/** The model is about paths between two ends (`path from …`), and has no motion from a start. */
export const betweenEnds = ({text, runTrouble}: State): boolean =>
  runTrouble?.code === heldIntegral || (runTrouble?.code === noDuration && /^path\b/m.test(text));
/** The equations are those of motions in time: no other variable is declared in its place. Without it no modes. */
export const inTime = ({text}: State): boolean => !/^independent\b(?!\s+t\b)/m.test(text);

export const initialState: State = {
  text: '',
  ends: '\n',
  saved: '',
  loads: 0,
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
  equationsText: '',
  runText: '',
  run: null,
  runTrouble: null,
  quick: false,
  answered: false,
  runLate: false,
  equationsLate: false,
  slow: false,
  deep: [],
  modes: null,
  phaseSpace: null,
  paths: null,
  found: null,
  section: null,
  sectionTrouble: null,
  sectionGone: false,
  pose: null,
  pins: [],
  pane: 'motion',
  charts: null,
  trail: 'some',
  forces: 'asked',
  busy: null,
  progress: null,
  word: null,
  storage: true,
};
