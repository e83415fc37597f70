// Colours of the page of tool paths, beside those of all pages in space.

export const DEPTHS = 12;  // colours from low to high

export const PATH_COLORS = {
  light: {stock: '#c7b07f', cut: '#d3d9dc', rest: '#2d7fb8', gouge: '#d5202a', tool: '#5b6670', shine: '#ffffff', line: '#1f5fa8', arc: '#c2561a',
          rapid: '#6b6f75'},
  dark: {stock: '#9c8758', cut: '#aab3b8', rest: '#3d9be0', gouge: '#ff4a50', tool: '#aeb9c2', shine: '#ffffff', line: '#7fc4ee', arc: '#ff9166',
         rapid: '#a8afb6'},
};

// Blue is low, red is high.
export function depthColor(bin, dark) {
  return `hsl(${Math.round(225 * (1 - bin / (DEPTHS - 1)))}, 75%, ${dark ? 62 : 42}%)`;
}
