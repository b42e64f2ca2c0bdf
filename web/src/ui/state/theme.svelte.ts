import { type Palette, paletteOf, type ThemeName } from '../../map/palette';

const kStored = 'smokemap.theme';

/** Light or dark: what the device prefers until somebody chooses. */
class Theme {
  name = $state<ThemeName>('light');
  readonly palette: Palette = $derived(paletteOf(this.name));

  start(): void {
    const stored = localStorage.getItem(kStored);
    const prefersDark = matchMedia('(prefers-color-scheme: dark)');
    this.#set(stored === 'light' || stored === 'dark' ? stored : prefersDark.matches ? 'dark' : 'light');
    prefersDark.addEventListener('change', ({ matches }) => {
      if (!localStorage.getItem(kStored)) this.#set(matches ? 'dark' : 'light');
    });
  }

  toggle(): void {
    this.#set(this.name === 'dark' ? 'light' : 'dark');
    localStorage.setItem(kStored, this.name);
  }

  #set(name: ThemeName): void {
    this.name = name;
    document.documentElement.dataset['theme'] = name;
  }
}

export const theme = new Theme();
