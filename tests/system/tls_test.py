#!/usr/bin/python3
"""Serves the page over TLS with certificates that it makes itself, as a client of Python's ssl module sees it.
Usage: tls_test.py PROGRAM
"""
import base64
import contextlib
import http.client
import json
import os
import pathlib
import re
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import threading
import unittest

PROGRAM = sys.argv.pop(1)
TOKEN = "operator-of-the-lab"
PATIENCE_SECS = 60


def openssl(*arguments):
    subprocess.run(["openssl", *map(str, arguments)], check=True, capture_output=True)


def make_certificate(folder, stem, name="localhost", days=365):
    """A certificate that confirms itself, and its key; which are at `folder`/`stem`.pem and .key."""
    certificate, key = folder / (stem + ".pem"), folder / (stem + ".key")
    openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", days,
            "-subj", "/CN=" + name, "-addext", f"subjectAltName=DNS:{name},DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out", certificate)
    return certificate, key


class Server:
    def __init__(self, folder, *arguments):
        environment = {**os.environ, "XDG_STATE_HOME": str(folder)}
        self.process = subprocess.Popen([PROGRAM, "serve", "demo:walk", "--ros", "off", "--pictures", "off", "--http_port", "0",
                                         "--token", TOKEN, *map(str, arguments)], stderr=subprocess.PIPE, text=True, env=environment)
        self.lines = []
        self.news = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()
        self.port = int(re.search(r"page at https://127\.0\.0\.1:(\d+)/", self.wait_for_line("page at")).group(1))

    def _read(self):
        for line in self.process.stderr:
            with self.news:
                self.lines.append(line)
                self.news.notify_all()

    def wait_for_line(self, text):
        found = None

        def is_there():
            nonlocal found
            found = next((line for line in self.lines if text in line), None)
            return found is not None

        with self.news:
            if not self.news.wait_for(is_there, PATIENCE_SECS):
                raise AssertionError(f"the log has no line with '{text}': {self.lines}")
        return found

    def stop(self):
        self.process.terminate()
        self.process.wait()
        self.process.stderr.close()

    def connect(self, trusted, version=None):
        context = ssl.create_default_context(cafile=str(trusted))
        if version:
            context.minimum_version = context.maximum_version = version
            context.set_ciphers("DEFAULT:@SECLEVEL=0")
        return context.wrap_socket(socket.create_connection(("127.0.0.1", self.port), PATIENCE_SECS), server_hostname="localhost")

    def get(self, trusted, target, **headers):
        context = ssl.create_default_context(cafile=str(trusted))
        connection = http.client.HTTPSConnection("localhost", self.port, timeout=PATIENCE_SECS, context=context)
        connection.request("GET", target, headers={"Authorization": "Bearer " + TOKEN, **headers})
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer, content

    def diagnostics(self, trusted):
        return json.loads(self.get(trusted, "/api/v1/diagnostics")[1])["http"]

    def exchange(self, data):
        """What comes back without TLS."""
        with socket.create_connection(("127.0.0.1", self.port), PATIENCE_SECS) as plain:
            plain.sendall(data)
            received = b""
            while more := plain.recv(65536):
                received += more
            return received


class WebSocket:
    """Only what comes: messages in one frame each, as the server sends them."""

    def __init__(self, server, trusted):
        self.connection = server.connect(trusted)
        key = base64.b64encode(os.urandom(16)).decode()
        self.connection.sendall((f"GET /api/v1/ws?token={TOKEN} HTTP/1.1\r\nHost: localhost:{server.port}\r\nUpgrade: websocket\r\n"
                                 f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.stream = self.connection.makefile("rb")
        status = self.stream.readline()
        assert status.startswith(b"HTTP/1.1 101"), status
        while self.stream.readline().strip():
            pass

    def receive(self):
        opcode, length = self.stream.read(2)
        if length == 126:
            (length,) = struct.unpack(">H", self.stream.read(2))
        elif length == 127:
            (length,) = struct.unpack(">Q", self.stream.read(8))
        return opcode & 15, self.stream.read(length)

    def receive_state(self):
        while True:
            opcode, content = self.receive()
            if opcode == 2 and content[0] == 1:
                return content

    def close(self):
        self.stream.close()
        self.connection.close()


class TlsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.certificate, cls.key = make_certificate(cls.folder, "first", "first.example")
        cls.server = Server(cls.folder, "--tls_certificate", cls.certificate, "--tls_key", cls.key)

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()
        cls.temporary.cleanup()

    def test_page_and_socket_are_encrypted(self):
        answer, content = self.server.get(self.certificate, "/?token=" + TOKEN)
        self.assertEqual(answer.status, 200)
        self.assertIn(b"<title>", content)
        self.assertIn("; Secure", answer.getheader("Set-Cookie"))
        page = WebSocket(self.server, self.certificate)
        self.assertGreater(len(page.receive_state()), 100)
        page.close()
        tls = self.server.diagnostics(self.certificate)["tls"]
        self.assertEqual(tls["names"], "first.example, localhost, 127.0.0.1")
        self.assertRegex(tls["valid_until"], r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d UTC$")

    def test_a_stranger_to_the_certificate_does_not_connect(self):
        other, _ = make_certificate(self.folder, "other")
        with self.assertRaises(ssl.SSLCertVerificationError):
            self.server.connect(other)

    def test_old_versions_are_refused(self):
        self.server.connect(self.certificate, ssl.TLSVersion.TLSv1_2).close()
        with self.assertRaises(ssl.SSLError):
            self.server.connect(self.certificate, ssl.TLSVersion.TLSv1_1)

    def test_http_is_told_where_to_go(self):
        host = f"localhost:{self.server.port}"
        answer = self.server.exchange(f"GET /?view=wall HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        self.assertTrue(answer.startswith(b"HTTP/1.1 308"), answer)
        self.assertIn(f"Location: https://{host}/?view=wall\r\n".encode(), answer)
        answer = self.server.exchange(f"GET /?token={TOKEN} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        self.assertTrue(answer.startswith(b"HTTP/1.1 400"), answer)
        self.assertIn(b"was not encrypted", answer)
        self.assertNotIn(b"Location", answer)
        self.assertNotIn(b"Set-Cookie", answer)
        answer = self.server.exchange(b"GET / HTTP/1.1\r\nHost: a\"><script>\r\n\r\n")
        self.assertTrue(answer.startswith(b"HTTP/1.1 400"), answer)
        self.assertNotIn(b"<script>", answer)

    def test_a_broken_handshake_costs_no_other(self):
        before = self.server.diagnostics(self.certificate)["rejected"].get("TLS handshake failed", 0)
        for garbage in (b"\x16\x03\x01\xff\xff" + b"\0" * 5000, b"\x16" * 3000, b"\x16\x03\x01\0\x01\x01"):
            with socket.create_connection(("127.0.0.1", self.server.port), PATIENCE_SECS) as plain:
                with contextlib.suppress(OSError):  # the server may have closed it already
                    plain.sendall(garbage)
                    plain.shutdown(socket.SHUT_WR)
                    while plain.recv(65536):
                        pass
        self.assertEqual(self.server.get(self.certificate, "/api/v1/session")[0].status, 200)
        after = self.server.diagnostics(self.certificate)["rejected"]["TLS handshake failed"]
        self.assertGreaterEqual(after - before, 3)

    def test_no_key_and_no_token_is_in_the_log(self):
        secrets = ["PRIVATE", TOKEN] + self.key.read_text().split("\n")[1:-2]
        for line in self.server.lines:
            self.assertFalse([secret for secret in secrets if secret and secret in line], line)


class ReloadTest(unittest.TestCase):
    def test_a_new_certificate_is_used_and_sockets_stay(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            certificate, key = make_certificate(folder, "used", "before.example")
            trusted = folder / "trusted.pem"
            trusted.write_bytes(certificate.read_bytes())
            server = Server(folder, "--tls_certificate", certificate, "--tls_key", key)
            page = WebSocket(server, trusted)
            page.receive_state()
            # A damaged file: what was there stays.
            good = certificate.read_bytes()
            certificate.write_bytes(good[: len(good) // 2])
            server.wait_for_line("The certificate from before stays in use")
            tls = server.diagnostics(trusted)["tls"]
            self.assertEqual((tls["names"].split(",")[0], tls["reloads"], tls["failed_reloads"]), ("before.example", 0, 1))
            self.assertIn("--tls_certificate=" + str(certificate), tls["last_error"])
            # A new pair, moved to its place.
            new_certificate, new_key = make_certificate(folder, "new", "after.example")
            new_key.rename(key)
            new_certificate.rename(certificate)
            server.wait_for_line("the new certificate of after.example")
            trusted.write_bytes(certificate.read_bytes())
            self.assertEqual(server.diagnostics(trusted)["tls"]["reloads"], 1)
            for _ in range(10):
                page.receive_state()  # the socket of before
            page.close()
            server.stop()

    def test_a_certificate_that_ends_soon_is_announced(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            certificate, key = make_certificate(folder, "short", days=3)
            server = Server(folder, "--tls_certificate", certificate, "--tls_key", key)
            self.assertIn("browsers refuse it then", server.wait_for_line("ends at"))
            server.stop()


class OptionsTest(unittest.TestCase):
    def refusal(self, *arguments):
        done = subprocess.run([PROGRAM, "serve", "demo:walk", "--ros", "off", "--http_port", "0", *map(str, arguments)],
                              capture_output=True, text=True, timeout=PATIENCE_SECS)
        self.assertEqual(done.returncode, 2, done.stderr)
        return done.stderr

    def test_files_that_cannot_be_used_are_named(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            certificate, key = make_certificate(folder, "one")
            _, other_key = make_certificate(folder, "two")
            openssl("x509", "-in", certificate, "-outform", "der", "-out", folder / "one.der")
            openssl("pkey", "-in", key, "-aes256", "-passout", "pass:secret", "-out", folder / "closed.key")
            (folder / "empty.pem").touch()
            (folder / "damaged.pem").write_bytes(certificate.read_bytes()[:200] + b"\n-----END CERTIFICATE-----\n")
            for arguments, reason in {
                (certificate, None): "--tls_certificate: needs its private key; set --tls_key=FILE, too",
                (None, key): "--tls_key: needs its certificate",
                (folder / "missing.pem", key): "missing.pem: cannot be read: No such file",
                (folder, key): "a folder; name the PEM file",
                (folder / "empty.pem", key): "the file is empty",
                (folder / "one.der", key): "Convert DER with openssl x509",
                (folder / "damaged.pem", key): "damaged.pem: damaged",
                (certificate, other_key): "two.key: not the key of the certificate",
                (certificate, certificate): "no private key in it",
                (certificate, folder / "closed.key"): "the key has a passphrase",
            }.items():
                options = [f"--{option}={file}" for option, file in zip(("tls_certificate", "tls_key"), arguments) if file]
                with self.subTest(options):
                    self.assertIn(reason, self.refusal(*options))

    def test_base_path_and_proxies_that_cannot_be_used_are_named(self):
        self.assertIn("--base_path=lab3: expected such as /lab3", self.refusal("--base_path=lab3"))
        self.assertIn("--trusted_proxies=10.0.0.0/33: '10.0.0.0/33' is not an address", self.refusal("--trusted_proxies=10.0.0.0/33"))


if __name__ == "__main__":
    unittest.main()
