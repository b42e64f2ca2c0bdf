import { mount } from 'svelte';
import App from './App.svelte';
import './app.css';
import { currentLanguage, setLanguage } from '../ui/i18n.svelte';
import { theme } from '../ui/state/theme.svelte';

theme.start();
setLanguage(currentLanguage());
mount(App, { target: document.getElementById('app')! });
