// A small reverse proxy, as a lab has one in front of several servers: HTTP and WebSockets, below a path if wanted.
import { once } from 'node:events';
import { createServer, request } from 'node:http';
import { connect } from 'node:net';

/** @param {string} server  its URL
 *  @param {{prefix?: string, strips?: boolean, headers?: Record<string, string>, pages?: Record<string, string>}} [options]
 *    prefix: paths below it go to the server, all others are answered with 404; strips: without the prefix;
 *    headers: are added to each request; pages: HTML by path, of the proxy itself
 *  @returns {Promise<{url: string, stop: () => Promise<void>}>} */
export async function startProxy(server, { prefix = '', strips = false, headers = {}, pages = {} } = {}) {
  const { hostname, port } = new URL(server);
  const pathOf = (url) => {
    if (!url.startsWith(prefix)) return null;
    return strips ? url.slice(prefix.length) || '/' : url;
  };
  const upgraded = new Set();  // the server does not close these
  const proxy = createServer((incoming, answer) => {
    const page = pages[incoming.url], path = pathOf(incoming.url);
    if (page !== undefined) return answer.setHeader('Content-Type', 'text/html').end(page);
    if (path === null) return answer.writeHead(404).end('not of this server');
    const outgoing = request({ hostname, port, path, method: incoming.method, headers: { ...incoming.headers, ...headers } });
    outgoing.on('response', (response) => {
      answer.writeHead(response.statusCode, response.rawHeaders);
      response.pipe(answer);
    });
    outgoing.on('error', () => answer.writeHead(502).end('<h1>Bad gateway</h1>'));
    return incoming.pipe(outgoing);
  });
  proxy.on('upgrade', (incoming, socket) => {
    const path = pathOf(incoming.url);
    if (path === null) return socket.end('HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n');
    const further = connect(Number(port), hostname, () => {
      const lines = Object.entries({ ...incoming.headers, ...headers }).map(([name, value]) => `${name}: ${value}\r\n`);
      further.write(`GET ${path} HTTP/1.1\r\n${lines.join('')}\r\n`);
      further.pipe(socket);
      socket.pipe(further);
    });
    for (const [one, other] of [[socket, further], [further, socket]]) {
      upgraded.add(one);
      one.on('error', () => other.destroy());
      one.on('close', () => upgraded.delete(one));
    }
    return undefined;
  });
  proxy.listen(0, '127.0.0.1');
  await once(proxy, 'listening');
  return {
    url: `http://127.0.0.1:${proxy.address().port}${prefix}/`,
    async stop() {
      const closed = once(proxy, 'close');
      proxy.close();
      proxy.closeAllConnections();
      for (const socket of upgraded) socket.destroy();
      await closed;
    },
  };
}
