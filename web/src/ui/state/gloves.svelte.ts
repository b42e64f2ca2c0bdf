const kStored = 'smokemap.gloves';

/** Gloves on: larger targets with wider gaps, blunter taps, and what destroys must be held. Kept per device. */
class Gloves {
  on = $state(false);

  start(): void {
    this.#set(localStorage.getItem(kStored) === 'on');
  }
  toggle(): void {
    this.#set(!this.on);
    localStorage.setItem(kStored, this.on ? 'on' : 'off');
  }

  #set(on: boolean): void {
    this.on = on;
    document.documentElement.toggleAttribute('data-gloves', on);
  }
}

export const gloves = new Gloves();
