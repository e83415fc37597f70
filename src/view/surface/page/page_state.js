// What follows # in the address: the view, for links and for pictures without a hand.

const NUMBERS = ['at', 'ball', 'cut', 'eye', 'opacity', 'time'];

// #at=X,Y&ball=X,Y&cut=ANGLE,OFFSET&eye=EAST,NORTH,UP,DISTANCE&opacity=0.5&theme=dark&hide=seam,ground&figure; of tool paths #time=MINUTES
export function parseFragment(fragment) {
  const state = {hide: [], figure: false, theme: null};
  for (const part of fragment.replace(/^#/, '').split('&')) {
    const [name, value = ''] = part.split('=');
    if (NUMBERS.includes(name)) {
      const numbers = value.split(',').map(Number);
      if (value !== '' && numbers.every(Number.isFinite)) state[name] = numbers;
    } else if (name === 'hide')
      state.hide = value.split(',').filter(Boolean);
    else if (name === 'theme' && ['light', 'dark'].includes(value))
      state.theme = value;
    else if (name === 'figure')
      state.figure = true;
    else if (name === 'cut-ground')
      state.cutGround = true;
    else if (name === 'plain')
      state.plain = true;
  }
  return state;
}
