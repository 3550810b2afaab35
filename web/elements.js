// List of the elements of index.html that the code fills. It is checked once at the start.

/** id -> tag */
export const ELEMENTS = /** @type {const} */ ({
  'status': 'div', 'status-word': 'span', 'status-note': 'span', 'clock': 'time', 'kiosk-line': 'p', 'banner': 'p',
  'rate': 'dd', 'latency': 'span', 'latency-p95': 'small', 'sample': 'dd', 'time-code': 'dd',
  'source': 'span', 'viewers': 'span', 'role': 'span',
  'about': 'p', 'tools': 'div', 'more': 'section', 'dark': 'button', 'copy-link': 'button', 'show-keys': 'button', 'announcer': 'p',
  'key-map': 'dialog', 'key-list': 'div', 'character-keys': 'input', 'close-keys': 'button',
  'stage': 'section', 'head-names': 'div', 'people': 'div', 'class-shape': 'template',
  'view': 'div', 'cameras': 'div', 'loads-shown': 'select', 'points': 'dl', 'camera-images': 'div',
  'com': 'dd', 'cop': 'dd', 'support': 'dd', 'compression-row': 'div', 'compression': 'dd',
  'picture': 'section', 'picture-frame': 'div',
  'picture-image': 'img', 'picture-note': 'p', 'picture-on': 'input', 'picture-camera': 'select',
  'save-picture': 'button',
  'hand-load': 'form', 'hand-person': 'select', 'hand': 'select', 'hand-kg': 'input',
  'loads': 'ol', 'legend': 'ul', 'loads-hint': 'p',
  'transport': 'section', 'play': 'button', 'step-back': 'button', 'step-forward': 'button', 'speed': 'select',
  'moment': 'input', 'oldest': 'span', 'go-live': 'button',
  'mark-pad': 'div', 'mark-buttons': 'div', 'mark-form': 'form', 'mark-text': 'input', 'mark-said': 'p',
  'mark-undo': 'button', 'marks': 'section', 'mark-list': 'ol', 'mark-earlier': 'p',
  'body-map': 'section', 'body-middle': 'div', 'body-right': 'div', 'body-left': 'div',
  'body-mark': 'template',
  'alarm': 'section', 'alarm-stars': 'b', 'alarm-head': 'span', 'alarm-detail': 'small', 'alarm-told': 'p',
  'alarm-show': 'button', 'acknowledge': 'button', 'alarm-sound': 'button', 'tab-alarms': 'button', 'alarms': 'section',
  'alarm-list': 'ol', 'alarm-rate': 'p', 'alarm-test': 'button',
  'strip-rows': 'canvas', 'tabs': 'div', 'side': 'aside',
  'plots': 'section', 'plot-window': 'div', 'plot-joints': 'div', 'plot-chosen': 'span',
  'plot-list': 'div', 'floor-plan': 'canvas', 'dash-sample': 'template', 'plot-csv': 'button', 'plot-png': 'button',
  'stream': 'details', 'stream-line': 'span', 'stream-rows': 'tbody',
  'diagnostics': 'section', 'problems': 'ul',
  'tab-controls': 'button', 'control-person': 'select',
  'trial-form': 'form', 'trial-person': 'input', 'trial-condition': 'input', 'trial-number': 'input', 'trial-run': 'button',
  'trial-note': 'p', 'trial-list': 'ol',
  'recording-form': 'form', 'recording-label': 'input', 'recording-run': 'button', 'recording-note': 'p',
  'clip-form': 'form', 'clip-secs': 'input', 'clip-last': 'button', 'clip-next': 'button', 'clip-begin': 'button',
  'clip-end': 'button', 'clip-note': 'p', 'job-list': 'ul',
  'person-form': 'form', 'person-name': 'input', 'person-mass': 'input', 'person-sex': 'select', 'person-height': 'input',
  'person-note': 'p',
  'hands-form': 'form', 'hands-right': 'input', 'hands-left': 'input', 'hands-both': 'input', 'hands-note': 'p',
  'limits-form': 'form', 'limits-medium': 'input', 'limits-high': 'input', 'limits-note': 'p', 'file-list': 'ul',
});

/** @typedef {{[Id in keyof typeof ELEMENTS]: HTMLElementTagNameMap[(typeof ELEMENTS)[Id]]}} Elements */

/** @param {Pick<Document, 'getElementById'>} page
 *  @returns {Elements}
 *  @throws {Error} naming the missing elements */
export function findElements(page) {
  const found = Object.entries(ELEMENTS).map(
    ([id, tag]) => /** @type {const} */ ([id, tag, page.getElementById(id)]));
  const missing = found.filter(([, tag, element]) => element?.localName !== tag)
    .map(([id, tag]) => `<${tag} id="${id}">`);
  if (missing.length > 0) throw new Error(`index.html has no ${missing.join(', ')}; reload the page`);
  return /** @type {Elements} */ (Object.fromEntries(found.map(([id, , element]) => [id, element])));
}
