import { mount } from 'svelte';
import App from './App.svelte';
import './app.css';
import { startLanguage } from '../ui/i18n.svelte';
import { gloves } from '../ui/state/gloves.svelte';
import { theme } from '../ui/state/theme.svelte';

theme.start();
gloves.start();
// Plain http to another machine has no service workers: such a page needs its server to be loaded again.
if (import.meta.env.PROD) void navigator.serviceWorker?.register('/sw.js');
void startLanguage().then(() => mount(App, { target: document.getElementById('app')! }));
