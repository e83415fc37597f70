// What faces and lines are; the numbers are those of src/view/surface/shape.hpp.

export const SPHERE = 0, CYLINDER = 1, PLANE = 2, WALL = 3, GROUND = 4;
export const SEAM = 0, VALLEY = 1, RIM = 2;

// By kind of patch: what it is, and what the ball touches there.
export const PATCH_NAMES = ['sphere', 'cylinder', 'plane'];
export const TOUCHED_NAMES = ['vertex', 'edge', 'face'];
export const LINE_NAMES = ['seam', 'valley', 'rim'];

// The colours of krepl's other pictures of surfaces, a little lighter, since these are lit.
export const COLORS = {
  light: {
    plane: '#e2cc9c',
    cylinder: '#6fa8d6',
    sphere: '#e0735c',
    wall: '#b9b3a6',
    ground: '#8f9a82',
    plain: '#d9d5cb',
    seam: '#6a6253',
    valley: '#16202a',
    rim: '#8a1c62',
    cut: '#0b6e99',
    ball: '#f4f6f8',
    contact: '#d4007f',
    paper: '#eef1f3'
  },
  dark: {
    plane: '#d8c08c',
    cylinder: '#5f9bcd',
    sphere: '#dc6a54',
    wall: '#8d887c',
    ground: '#77836b',
    plain: '#b9b5ab',
    seam: '#4f4a40',
    valley: '#0c1116',
    rim: '#ff7cc8',
    cut: '#6cc3e8',
    ball: '#ffffff',
    contact: '#ff3fb0',
    paper: '#10161b'
  },
};
