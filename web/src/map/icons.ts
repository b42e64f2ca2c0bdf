/**
 * Every sign of the interface as one outline on a 24 x 24 field, drawn for this project: stroked 2 wide with round ends.
 * One form serves both the page (an <svg> path) and the canvas (a Path2D).
 */
export const kIcons = {
  prepare: 'M4 5h16v14H4z M4 11h7 M11 5v3 M11 14v5 M15 11h5',
  sketch: 'M4 20l1-4L16 5l3 3L8 19z M14 7l3 3',
  match: 'M3 6h7v12H3z M14 6h7v12h-7z M10 12h4',
  operate: 'M12 21s-7-6.2-7-11a7 7 0 0 1 14 0c0 4.800-7 11-7 11z M12 7.500a2.500 2.500 0 1 0 0 5a2.500 2.500 0 1 0 0-5',
  review: 'M4 12a8 8 0 1 0 2.500-5.800 M4 4v4h4 M12 8v4l3 2',
  pen: 'M4 20l1-4L16 5l3 3L8 19z',
  eraser: 'M8 19h12 M4.500 14.500L14 5l6 6-8 8H8z M9 10l6 6',
  undo: 'M9 7L4 12l5 5 M4 12h10a6 6 0 0 1 6 6',
  redo: 'M15 7l5 5-5 5 M20 12H10a6 6 0 0 0-6 6',
  door: 'M5 21h14 M7 21V4h10v17 M14 12v1',
  wall: 'M4 6h16v12H4z M4 12h16 M10 6v6 M15 12v6',
  window: 'M4 9h16v6H4z M12 9v6',
  gap: 'M3 12h6 M15 12h6 M12 8v8',
  upload: 'M12 16V5 M7 9l5-5 5 5 M5 20h14',
  camera: 'M4 8h4l2-3h4l2 3h4v11H4z M12 10a3.500 3.500 0 1 0 0 7a3.500 3.500 0 1 0 0-7',
  corners: 'M4 9V4h5 M15 4h5v5 M20 15v5h-5 M9 20H4v-5',
  scale: 'M3 9h18v6H3z M7 9v3 M11 9v3 M15 9v3 M19 9v3',
  robot: 'M5 9h14v9H5z M9 13v1 M15 13v1 M12 9V5 M11 4h2 M3 12v3 M21 12v3',
  send: 'M5 12l5 5L20 7',
  check: 'M5 12l5 5L20 7',
  close: 'M6 6l12 12 M18 6L6 18',
  plus: 'M12 5v14 M5 12h14',
  minus: 'M5 12h14',
  fit: 'M4 9V4h5 M20 9V4h-5 M4 15v5h5 M20 15v5h-5 M9 12h6 M12 9v6',
  north: 'M12 3l5 16-5-4-5 4z',
  layers: 'M12 4l9 5-9 5-9-5z M3 14l9 5 9-5',
  goal: 'M6 21V4 M6 5h11l-3 4 3 4H6',
  pin: 'M9 4h6l-1 6 4 4H6l4-4z M12 14v7',
  measure: 'M4 16L16 4l4 4L8 20z M9 11l2 2 M12 8l2 2',
  link: 'M10 14l4-4 M9 8l2-2a4 4 0 0 1 6 6l-2 2 M15 16l-2 2a4 4 0 0 1-6-6l2-2',
  unlink: 'M9 8l2-2a4 4 0 0 1 6 6l-2 2 M15 16l-2 2a4 4 0 0 1-6-6l2-2 M4 4l16 16',
  eye: 'M2 12s4-7 10-7 10 7 10 7-4 7-10 7S2 12 2 12z M12 9a3 3 0 1 0 0 6a3 3 0 1 0 0-6',
  download: 'M12 4v11 M7 11l5 5 5-5 M5 20h14',
  sun: 'M12 8a4 4 0 1 0 0 8a4 4 0 1 0 0-8 M12 2v2 M12 20v2 M2 12h2 M20 12h2 M5 5l1.500 1.500 M17.500 17.500L19 19 M19 5l-1.500 1.500 M6.500 17.500L5 19',
  moon: 'M20 14A8 8 0 1 1 10 4a6.500 6.500 0 0 0 10 10z',
  people: 'M9 5a3.500 3.500 0 1 0 0 7a3.500 3.500 0 1 0 0-7 M2.500 20c0-3.500 3-5.500 6.500-5.500s6.500 2 6.500 5.500 M16 5.500a3.500 3.500 0 0 1 0 6.500 M18 15c2 .700 3.500 2.500 3.500 5',
  glove: 'M7 21v-5l-3-4a1.800 1.800 0 0 1 3-2l1 1V5a1.500 1.500 0 0 1 3 0V4a1.500 1.500 0 0 1 3 0v1a1.500 1.500 0 0 1 3 0v2a1.500 1.500 0 0 1 2.500 1v6l-2 4v3z M7 18h10',
  signal: 'M5 18v-3 M10 18v-6 M15 18V9 M20 18V6',
  crosshair: 'M12 5a7 7 0 1 0 0 14a7 7 0 1 0 0-14 M12 2v5 M12 17v5 M2 12h5 M17 12h5',
  stop: 'M8 3h8l5 5v8l-5 5H8l-5-5V8z',
  explore: 'M12 3a9 9 0 1 0 0 18a9 9 0 1 0 0-18 M15.500 8.500l-2 5-5 2 2-5z',
  alert: 'M12 4l9 16H3z M12 10v4 M12 17v.100',
  trash: 'M5 7h14 M9 7V4h6v3 M7 7l1 13h8l1-13',
  list: 'M9 6h11 M9 12h11 M9 18h11 M4 6h.100 M4 12h.100 M4 18h.100',
  back: 'M15 5l-7 7 7 7',
  forward: 'M9 5l7 7-7 7',
  sheet: 'M6 3h12v18H6z M9 8h6 M9 12h6 M9 16h3',
  gas_bottle: 'M9 9a3 3 0 0 1 6 0v11a1 1 0 0 1-1 1h-4a1 1 0 0 1-1-1z M10.500 6.200V3h3v3.200 M13.500 4H17',
  victim: 'M12 3a2.500 2.500 0 1 0 0 5a2.500 2.500 0 1 0 0-5 M5 11h14 M12 11v5 M12 16l-4 5 M12 16l4 5',
  fire: 'M12 3c1 4 6 6 6 11a6 6 0 0 1-12 0c0-2.500 1.500-4 2.500-5.500C9 10 9.500 11 10.500 11.500 10.500 8.500 11 5.500 12 3z',
  hazard: 'M12 4l9 16H3z M12 10v4 M12 17v.100',
  exit: 'M13 4H5v16h8 M10 12h11 M17 8l4 4-4 4',
  water: 'M12 3c3 4 6 7 6 11a6 6 0 0 1-12 0c0-4 3-7 6-11z',
  access: 'M11 4h8v16h-8 M3 12h11 M10 8l4 4-4 4',
  shut_off: 'M12 4v8 M7 7a7 7 0 1 0 10 0',
  note: 'M5 4h14v11l-5 5H5z M14 20v-5h5 M8 9h8',
} as const;

export type IconName = keyof typeof kIcons;

const kPrepared = new Map<IconName, Path2D>();

export function iconPath(name: IconName): Path2D {
  const known = kPrepared.get(name);
  if (known) return known;
  const path = new Path2D(kIcons[name]);
  kPrepared.set(name, path);
  return path;
}

/** Draws an icon centred on the origin of the current transform, `size` wide. */
export function drawIcon(context: CanvasRenderingContext2D, name: IconName, size: number, colour: string): void {
  context.save();
  context.scale(size / 24, size / 24);
  context.translate(-12, -12);
  context.lineWidth = 2;
  context.lineCap = 'round';
  context.lineJoin = 'round';
  context.strokeStyle = colour;
  context.stroke(iconPath(name));
  context.restore();
}
