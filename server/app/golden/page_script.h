/// What runs in a page of which a picture is taken, in a world of its own: the page's scripts
/// cannot reach it.
#pragma once

namespace kinescope::app {

/// Before the scripts of the page: its random numbers are the same each time. A function of the
/// time of day at which its clock stands still, ms since 1970; null: it goes on.
inline constexpr char kSteadyScript[] = R"js((now) => {
  let seed = 1;
  Math.random = () => {
    seed = seed + 0x6D2B79F5 | 0;
    let mixed = Math.imul(seed ^ seed >>> 15, 1 | seed);
    mixed = mixed + Math.imul(mixed ^ mixed >>> 7, 61 | mixed) ^ mixed;
    return ((mixed ^ mixed >>> 14) >>> 0) / 4294967296;
  };
  if (now === null) return;
  globalThis.Date = new Proxy(Date, {
    construct: (target, args, made) => Reflect.construct(target, args.length === 0 ? [now] : args, made),
    apply: (target) => new target(now).toString(),
    get: (target, name) => (name === 'now' ? () => now : Reflect.get(target, name)),
  });
})js";

/// When the page is loaded: resolves when fonts and pictures are there and `selector` finds
/// something ("": no matter), to the status of the answer to its request. Then nothing moves by
/// itself any more.
inline constexpr char kReadyScript[] = R"js(async (selector) => {
  const nextFrame = () => new Promise((done) => { requestAnimationFrame(done); });
  while (selector !== '' && document.querySelector(selector) === null) await nextFrame();
  const isInView = (image) => {
    const { left, top, right, bottom } = image.getBoundingClientRect();
    return left < innerWidth && top < innerHeight && right > 0 && bottom > 0;
  };
  await Promise.all([...document.images].filter(isInView).map((image) => image.decode().catch(() => {})));
  await document.fonts.ready;
  const still = new CSSStyleSheet();
  still.replaceSync(`*, ::before, ::after {
    animation-delay: 0s !important; transition: none !important; caret-color: transparent !important;
    scroll-behavior: auto !important; }`);
  document.adoptedStyleSheets.push(still);
  for (const animation of document.getAnimations()) {
    if (animation.effect?.getComputedTiming().endTime === Infinity) animation.cancel();
    else animation.finish();
  }
  for (const media of document.querySelectorAll('video, audio')) media.pause();
  return performance.getEntriesByType('navigation')[0]?.responseStatus ?? 0;
})js";

/// After two frames, with all that has changed before them: what a person sees, in the order of the
/// document. For the limits see ElementsFrom().
inline constexpr char kLookScript[] = R"js(async () => {
  const MOST_ELEMENTS = 5000, MOST_TEXT = 300, MOST_NAME = 60, MOST_PIECES = 3, LEAST_PX = 2;
  const CONTROLS = 'input, select, textarea', SEEN = 'img, canvas, video, iframe, object, embed, progress, meter, [role=img]';
  const WHOLE = 'button, a, summary, label, legend, h1, h2, h3, h4, h5, h6, p, dt, dd, th, td, caption, figcaption, option, '
    + '[role=button], [role=link], [role=tab], [role=heading], [role=option], [role=menuitem], [role=cell]';
  const PRESSED = 'button, a, summary, [role=button], [role=link], [role=tab], [role=option], [role=menuitem]';
  const SAID = `${PRESSED}, h1, h2, h3, h4, h5, h6, [role=heading]`;
  const ROLES = {
    a: 'link', button: 'button', canvas: 'canvas', caption: 'caption', dd: 'definition', dt: 'term', embed: 'embed', figcaption: 'caption',
    iframe: 'iframe', img: 'image', label: 'label', legend: 'legend', li: 'listitem', meter: 'meter', object: 'object', option: 'option',
    p: 'paragraph', progress: 'progressbar', select: 'combobox', summary: 'summary', td: 'cell', textarea: 'textbox', th: 'header',
    video: 'video',
  };
  const INPUT_ROLES = {
    button: 'button', checkbox: 'checkbox', color: 'color', file: 'file', image: 'button', number: 'spinbutton', radio: 'radio',
    range: 'slider', reset: 'button', search: 'searchbox', submit: 'button',
  };
  const STATES = { ariaPressed: 'pressed', ariaSelected: 'selected', ariaChecked: 'checked', ariaExpanded: 'open' };
  const found = [];

  const line = (text) => {
    const joined = text.replace(/\s+/g, ' ').trim();
    return joined.length > MOST_TEXT ? `${joined.slice(0, MOST_TEXT)}…` : joined;
  };
  const common = (a, b) => ({
    left: Math.max(a.left, b.left), top: Math.max(a.top, b.top), right: Math.min(a.right, b.right), bottom: Math.min(a.bottom, b.bottom),
  });
  const isEmpty = ({ left, top, right, bottom }) => right - left < LEAST_PX || bottom - top < LEAST_PX;
  const moved = ({ left, top, right, bottom }, [x, y]) => ({ left: left + x, top: top + y, right: right + x, bottom: bottom + y });
  const tenth = (px) => Math.round(10 * px) / 10;
  const childrenOf = (element) => {
    if (element.localName === 'slot' && element.assignedNodes().length > 0) return element.assignedNodes();
    return [...(element.shadowRoot ?? element).childNodes];
  };
  const isChanging = (element) => element.hasAttribute('data-changing');
  const isText = (node) => node.nodeType === Node.TEXT_NODE && node.data.trim() !== '';
  const styles = new Map();
  const styleOf = (element) => {
    if (!styles.has(element)) styles.set(element, getComputedStyle(element));
    return styles.get(element);
  };
  const isThere = (element) => {
    const { display, opacity } = styleOf(element);
    return display !== 'none' && Number(opacity) > 0 && (display === 'contents' || element.checkVisibility());
  };
  const isShown = (element) => isThere(element) && styleOf(element).visibility === 'visible';
  const isInline = (element) => /^(inline|contents)/.test(styleOf(element).display);
  const isJoined = (element) => /^(inline|contents)$/.test(styleOf(element).display) && element.localName !== 'br';

  /** What is seen of it in words; what changes by itself is left out. */
  function textOf(element) {
    return childrenOf(element).map((child) => {
      if (child.nodeType === Node.TEXT_NODE) return child.data;
      if (child.nodeType !== Node.ELEMENT_NODE || child.matches(`script, style, ${CONTROLS}`) || !isShown(child)) return '';
      if (isChanging(child)) return ' … ';
      if (child.matches(SEEN)) return ` ${labelOf(child)} `;
      return isJoined(child) ? textOf(child) : ` ${textOf(child)} `;
    }).join('');
  }

  /** What names it for people who do not see it. */
  function labelOf(element) {
    const ids = (element.getAttribute('aria-labelledby') ?? '').split(/\s+/);
    const labelling = ids.flatMap((id) => element.ownerDocument.getElementById(id) ?? []);
    if (labelling.length > 0) return line(labelling.map(textOf).join(' '));
    const labels = element.matches(CONTROLS) ? [...element.labels ?? []].map(textOf).join(' ') : '';
    return line(element.ariaLabel || labels || element.getAttribute('alt') || element.getAttribute('title')
      || element.getAttribute('placeholder') || '');
  }

  /** How many elements have text of their own in it; Infinity: there is a control. */
  function piecesOf(element) {
    if (element.matches(CONTROLS)) return Infinity;
    const children = childrenOf(element);
    const inner = children.filter((child) => child.nodeType === Node.ELEMENT_NODE && isShown(child)).map(piecesOf);
    return inner.reduce((sum, each) => sum + each, children.some(isText) ? 1 : 0);
  }

  /** Whether it is one text: a line, a label, a paragraph. */
  function isOneText(element) {
    const pieces = piecesOf(element);
    if (pieces === 0 || pieces === Infinity) return false;
    if (pieces <= MOST_PIECES && element.matches(PRESSED)) return true;
    const children = childrenOf(element);
    const elements = children.filter((child) => child.nodeType === Node.ELEMENT_NODE && isShown(child));
    if (children.some(isText) && elements.every(isInline)) return true;
    if (elements.some((child) => child.hasAttribute('id') || isChanging(child))) return false;
    return (pieces <= MOST_PIECES && element.matches(WHOLE)) || (elements.length > 1 && elements.every(isInline));
  }

  function stateOf(element) {
    const states = Object.entries(STATES).filter(([name]) => element[name] === 'true').map(([, word]) => word);
    if (element.matches(':disabled')) states.push('disabled');
    return states.length === 0 ? '' : ` [${states.join(', ')}]`;
  }

  function valueOf(element) {
    if (element.localName === 'select') return [...element.selectedOptions].map((option) => option.text).join(', ');
    if (element.type === 'checkbox' || element.type === 'radio') return element.checked ? 'checked' : 'not checked';
    if (element.type === 'password') return '•'.repeat(element.value.length);
    return element.value || element.placeholder || '';
  }

  /** `row`: the list item or table row that it is in, with the text that comes first there. */
  function nameOf(element, text, row) {
    if (element.getAttribute('id')) return element.getAttribute('id');
    if (element.localName === 'dd') {
      let before = element.previousElementSibling;
      while (before !== null && before.localName !== 'dt') before = before.previousElementSibling;
      if (before !== null) return line(textOf(before));
    }
    const kind = element.classList[0] ?? element.localName;
    if (row?.label) return `${row.label} ${kind}`;
    if (element.localName === 'dt') return `${text} dt`;
    const isLabelled = element.hasAttribute('aria-label') || element.matches(`${CONTROLS}, ${SEEN}`);
    const isNamedByText = element.matches(SAID) && (piecesOf(element) === 1 || childrenOf(element).some(isText));
    const label = isLabelled ? labelOf(element) : isNamedByText ? text : '';
    if (label !== '' && label.length <= MOST_NAME) return label;
    const place = element.parentElement?.closest('[id]');
    return place ? `${place.getAttribute('id')} ${kind}` : kind;
  }

  function roleOf(element) {
    const [given] = (element.getAttribute('role') ?? '').trim().split(/\s+/);
    if (given !== '') return given === 'img' ? 'image' : given;
    if (element.localName === 'input') return INPUT_ROLES[element.type] ?? 'textbox';
    return /^h[1-6]$/.test(element.localName) ? 'heading' : ROLES[element.localName] ?? 'text';
  }

  /** `text` null: it changes by itself. */
  function add(element, box, text, row) {
    if (isEmpty(box)) return;
    if (found.length >= MOST_ELEMENTS) throw new Error(`the page has more than ${MOST_ELEMENTS} things to see`);
    const role = roleOf(element), seen = line(text ?? ''), name = line(nameOf(element, seen, row));
    const label = text !== null && element.hasAttribute('aria-label') ? labelOf(element) : '';
    const words = label === '' || label === seen || label === name ? seen : line(`${seen} (${label})`);
    found.push({
      name: name === '' ? 'text' : name, role, text: text === null ? '' : line(words + stateOf(element)), is_changing: text === null,
      box: [tenth(box.left), tenth(box.top), tenth(box.right - box.left), tenth(box.bottom - box.top)],
    });
    if (row && row.label === '') row.label = words;
  }

  /** `clip`: what of the page is seen where the element is; `shift`: from its document to the picture. */
  function visit(element, clip, row, shift) {
    if (element.matches('script, style, template, noscript') || !isThere(element)) return;
    const style = styleOf(element);
    const own = moved(element.getBoundingClientRect(), shift), hasBox = style.display !== 'contents';
    const box = common(own, clip);
    const isCut = hasBox && !isInline(element) && (style.overflowX !== 'visible' || style.overflowY !== 'visible');
    const inner = isCut ? box : clip;
    if (isCut && isEmpty(inner)) return;
    const isVisible = style.visibility === 'visible';
    if (isVisible && isChanging(element)) return add(element, box, null, row);
    if (isVisible && element.matches(CONTROLS)) return add(element, box, valueOf(element), row);
    if (isVisible && element.matches(SEEN)) {
      add(element, box, labelOf(element), row);
      if (element.localName === 'iframe') visitFrame(element, inner, shift);
      return;
    }
    if (isVisible && isOneText(element)) {
      const words = new Range(), changing = [...element.querySelectorAll('[data-changing]')].filter(isShown);
      words.selectNodeContents(element);
      const hasOwnBox = element.matches(PRESSED) || changing.length > 0 || element.shadowRoot;
      add(element, hasOwnBox ? box : common(moved(words.getBoundingClientRect(), shift), inner), textOf(element), row);
      for (const each of changing) add(each, common(moved(each.getBoundingClientRect(), shift), inner), null, row);
      return;
    }
    const texts = isVisible ? childrenOf(element).filter(isText) : [];
    if (texts.length > 0) {  // beside controls or paragraphs
      const words = new Range();
      words.setStartBefore(texts[0]);
      words.setEndAfter(texts[texts.length - 1]);
      add(element, common(moved(words.getBoundingClientRect(), shift), inner), texts.map(({ data }) => data).join(' … '), row);
    }
    const rowHere = element.matches('li, tr, [role=listitem], [role=row]') ? { label: '' } : row;
    const before = found.length;
    for (const child of childrenOf(element)) if (child.nodeType === Node.ELEMENT_NODE) visit(child, inner, rowHere, shift);
    if (isVisible && found.length === before && element.matches(PRESSED)) {
      add(element, box, labelOf(element), row);
    }
  }

  function visitFrame(frame, clip, shift) {
    const inside = frame.contentDocument;  // null: of another site
    if (!inside?.documentElement) return;
    const { left, top } = frame.getBoundingClientRect();
    const at = [shift[0] + left + frame.clientLeft, shift[1] + top + frame.clientTop];
    const box = common(clip, { left: at[0], top: at[1], right: at[0] + frame.clientWidth, bottom: at[1] + frame.clientHeight });
    if (!isEmpty(box)) visit(inside.documentElement, box, null, at);
  }

  for (let frame = 0; frame < 2; ++frame) await new Promise((done) => { requestAnimationFrame(done); });
  visit(document.documentElement, { left: 0, top: 0, right: innerWidth, bottom: innerHeight }, null, [0, 0]);
  return { elements: found, height: Math.ceil(document.documentElement.scrollHeight) };
})js";

}  // namespace kinescope::app
