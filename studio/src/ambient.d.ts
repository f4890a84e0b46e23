declare module 'virtual:models' {
  /** Folder, name, text. */
  const models: [string, string, string][];
  export default models;
}

declare module '*/report/page/scene.js' {
  import type {Scene} from './contract';
  export interface View {
    width: number;
    height: number;
    unit: number;
    middle: number[];
    across: number;
    down: number;
    scale: number;
    right?: number[];
    up?: number[];
    toward?: number[];
  }
  export interface Item {
    kind: string;
    points: number[];
    [key: string]: unknown;
  }
  const scene: {
    duration(scene: Scene): number;
    direction(scene: Scene): 1 | -1;
    makeView(
      scene: Scene,
      width: number,
      height: number,
      camera: {azimuth: number; elevation: number; furniture?: boolean},
    ): View;
    frameItems(
      scene: Scene,
      view: View,
      s: number,
      options?: {trail?: 'none' | 'fading' | 'whole'; trailTime?: number; trailPieces?: number},
    ): Item[];
    furniture(scene: Scene, view: View): Item[];
    pointsAt(scene: Scene, element: Scene['elements'][number], s: number): number[];
    centreAt(scene: Scene, view: View, s: number): number[];
    forceSeries(element: Scene['elements'][number]): number;
    project(scene: Scene, view: View, p: number[], centre: number[]): [number, number, number, number];
  };
  export default scene;
}

declare module '*/report/page/painter.js' {
  import type {Item} from '*/report/page/scene.js';
  const painter: (context: CanvasRenderingContext2D) => {
    readColours(): void;
    paint(items: Item[], unit: number, options?: {opacity?: number; only?: number | null}): void;
  };
  export default painter;
}
