// What the page's JSDoc says of its types, held by TypeScript; for an editor: npx tsc -p tests/browser.
import assert from 'node:assert/strict';
import { relative } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';

const { default: ts } = await import('typescript').catch(() => {
  throw new Error('typescript is missing: npm ci --prefix tests/browser');
});
const root = fileURLToPath(new URL('../../', import.meta.url));
const config = ts.getParsedCommandLineOfConfigFile(fileURLToPath(new URL('tsconfig.json', import.meta.url)), {}, {
  ...ts.sys, onUnRecoverableConfigFileDiagnostic: ({ messageText }) => { throw new Error(String(messageText)); },
});
const program = ts.createProgram(config.fileNames, config.options);
const checker = program.getTypeChecker();
const modules = config.fileNames.map((name) => program.getSourceFile(name));

/** "web/app.js:12" */
const placeOf = (file, position) =>
  `${relative(root, file.fileName)}:${file.getLineAndCharacterOfPosition(position).line + 1}`;

test('the modules of the page have no type errors', () => {
  assert.ok(modules.length >= 20, `${modules.length} modules are checked`);
  const wrong = [...config.errors, ...ts.getPreEmitDiagnostics(program)].map(({ file, start, messageText }) =>
    `${file ? placeOf(file, start) : 'tsconfig.json'}: ${ts.flattenDiagnosticMessageText(messageText, '\n')}`);
  assert.deepEqual(wrong, []);
});

test('no value in the page has the declared or inferred type any', () => {
  const found = [];
  const said = [ts.SyntaxKind.AnyKeyword, ts.SyntaxKind.JSDocAllType, ts.SyntaxKind.JSDocUnknownType];
  const isOfAny = (node) => (checker.getTypeAtLocation(node).flags & ts.TypeFlags.Any) !== 0;
  /** Whether the compiler has no opinion on a name, though its value is used. */
  const isInferred = (name) => {
    if (!ts.isIdentifier(name) || name.text === '_' || !isOfAny(name)) return false;
    if (ts.isBindingElement(name.parent) && name.parent.propertyName === name) return false;
    const whole = ts.isPropertyAccessExpression(name.parent) && name.parent.name === name ? name.parent : name;
    const isDeclaredByThis = ts.isBinaryExpression(whole.parent) && whole.parent.left === whole;
    if (isDeclaredByThis) return isOfAny(whole.parent.right);
    const wanted = ts.isExpression(whole) ? checker.getContextualType(whole) : undefined;
    return wanted === undefined || (wanted.flags & ts.TypeFlags.Unknown) === 0;  // unknown: checked by whoever takes it
  };
  for (const file of modules) {
    const visit = (node, isComment) => {
      if (said.includes(node.kind) || !isComment && isInferred(node)) {
        found.push(`${placeOf(file, node.getStart(file))}: ${node.getText(file)}`);
      }
      for (const comment of node.jsDoc ?? []) visit(comment, true);
      ts.forEachChild(node, (child) => visit(child, isComment));
    };
    visit(file, false);
  }
  assert.deepEqual(found, []);
});
