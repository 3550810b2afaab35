// For pages of tests that look at nothing of the 3-D view: a WebGL that draws nothing. The page's programs run as they
// are, three.js and the scene included; what takes the time, the drawing in software, is left out.

/** In the page, before its own programs: canvases have a WebGL whose shaders compile, whose textures are complete and whose
 *  pictures stay empty. */
export function blankWebGl() {
  const TEXT = { 0x1F02: 'WebGL 2.0', 0x8B8C: 'WebGL GLSL ES 3.00' };  // VERSION, SHADING_LANGUAGE_VERSION
  const AREAS = [0x0C10, 0x0BA2];  // SCISSOR_BOX, VIEWPORT
  const COUNTS = [0x8B86, 0x8B89];  // ACTIVE_UNIFORMS, ACTIVE_ATTRIBUTES: a program has none, so none is looked for
  const LARGEST = 4096;  // of whatever has a limit
  /** @param {HTMLCanvasElement} canvas */
  const contextOf = (canvas) => {
    const answers = {
      canvas, drawingBufferWidth: canvas.width, drawingBufferHeight: canvas.height,
      getParameter: (name) => TEXT[name] ?? (AREAS.includes(name) ? [0, 0, canvas.width, canvas.height] : LARGEST),
      getContextAttributes: () => ({}), getExtension: () => null, getSupportedExtensions: () => [], isContextLost: () => false,
      getShaderPrecisionFormat: () => ({ rangeMin: 127, rangeMax: 127, precision: 23 }),
      getShaderParameter: () => true, getProgramParameter: (_, name) => (COUNTS.includes(name) ? 0 : true),
      getShaderInfoLog: () => '', getProgramInfoLog: () => '', getError: () => 0,
      checkFramebufferStatus: () => WebGL2RenderingContext.FRAMEBUFFER_COMPLETE,
    };
    // The others make something, which is given back to them, or return nothing.
    const context = {};
    for (const [name, { value }] of Object.entries(Object.getOwnPropertyDescriptors(WebGL2RenderingContext.prototype))) {
      if (typeof value === 'number') context[name] = value;
      if (typeof value === 'function') context[name] = () => ({});
    }
    return Object.assign(context, answers);
  };
  const contexts = new WeakMap();
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function get(kind, ...more) {
    if (!kind.startsWith('webgl')) return getContext.call(this, kind, ...more);
    if (!contexts.has(this)) contexts.set(this, contextOf(this));
    return contexts.get(this);
  };
}
