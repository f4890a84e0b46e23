import maupScene from '../../../src/report/page/scene.js';
import type {View} from '../../../src/report/page/scene.js';
import type {Scene} from '../contract';

const home = {azimuth: -0.9, elevation: 0.32};

/** Where a scene is seen from: turned in space, shifted in the plane, nearer or farther. */
export class Camera {
  azimuth = home.azimuth;
  elevation = home.elevation;
  zoom = 1;
  shift: [number, number] = [0, 0]; // px

  get moved(): boolean {
    return this.zoom !== 1 || this.shift[0] !== 0 || this.shift[1] !== 0 || this.azimuth !== home.azimuth;
  }

  reset(): void {
    Object.assign(this, {...home, zoom: 1, shift: [0, 0]});
  }

  turn(dx: number, dy: number): void {
    this.azimuth -= dx * 0.01;
    this.elevation = Math.min(1.57, Math.max(-1.57, this.elevation + dy * 0.01));
  }

  /** Zooms so that what is at (x, y) px of a picture with this middle stays there. */
  zoomAt(factor: number, x: number, y: number, middle: [number, number]): void {
    const zoom = Math.min(60, Math.max(0.05, this.zoom * factor)),
      f = zoom / this.zoom;
    this.shift = [
      x - middle[0] - f * (x - middle[0] - this.shift[0]),
      y - middle[1] - f * (y - middle[1] - this.shift[1]),
    ];
    this.zoom = zoom;
  }

  view(scene: Scene, width: number, height: number): View {
    const view = maupScene.makeView(scene, width, height, {azimuth: this.azimuth, elevation: this.elevation});
    view.scale *= this.zoom;
    view.across += this.shift[0];
    view.down += this.shift[1];
    return view;
  }
}

/** The place of the world under (x, y) px that is as far from the eye as `p`. */
export function placeUnder(scene: Scene, view: View, x: number, y: number, p: number[], centre: number[]): number[] {
  if (scene.dimension === 2)
    return [centre[0] + (x - view.across) / view.scale, centre[1] - (y - view.down) / view.scale];
  const [px, py, size] = maupScene.project(scene, view, p, centre),
    scale = view.scale * size;
  return p.map((value, k) => value + ((x - px) * view.right![k] - (y - py) * view.up![k]) / scale);
}
