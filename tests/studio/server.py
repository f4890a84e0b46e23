#!/usr/bin/env python3
"""The server of the studio under requests that no page would send, and under many at once.

usage: server.py MAUP FOLDER_OF_MODELS
"""
import concurrent.futures
import http.client
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

MAUP, MODELS = sys.argv[1], pathlib.Path(sys.argv[2])
failures = []


def expect(what, condition, detail=""):
    if not condition:
        failures.append(what)
        print(f"FAILED: {what} {str(detail)[:300]}", flush=True)


class Studio:
    def __init__(self, folder, *more):
        page = pathlib.Path(tempfile.mkdtemp())
        (page / "index.html").write_text("<!doctype html><meta charset=utf-8><title>page</title>")
        (page.parent / "secret.txt").write_text("secret")
        self.process = subprocess.Popen(
            [MAUP, "studio", str(folder), "--no-browser", "--json", "--page", str(page), *more],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        said = self.process.stdout.readline()
        if not said:
            return
        told = json.loads(said)
        self.port, self.address = told["port"], told["address"]
        self.host = f"127.0.0.1:{self.port}"
        self.cookie = ""

    def ask(self, method, path, body=None, headers=None, cookie=True):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        all_headers = {"Host": self.host, "Origin": f"http://{self.host}"}
        if cookie:
            all_headers["Cookie"] = self.cookie
        all_headers.update(headers or {})
        all_headers = {k: v for k, v in all_headers.items() if v is not None}
        connection.request(method, path, body, all_headers)
        response = connection.getresponse()
        content = response.read()
        connection.close()
        return response, content

    def enter(self):
        response, _ = self.ask("GET", self.address[self.address.index("/", 8):], cookie=False)
        self.cookie = (response.getheader("Set-Cookie") or "").split(";")[0]
        return response

    def request(self, session, **what):
        response, content = self.ask("POST", f"/api/request?session={session}", json.dumps(what))
        events = content.decode().strip().split("\n\n")
        kind, data = events[-1].split("\n", 1)
        assert kind == "event: answer", events[-1][:200]
        return json.loads(data[len("data: "):])

    def end(self):
        self.process.send_signal(signal.SIGINT)
        begin = time.time()
        code = self.process.wait(timeout=20)
        return code, time.time() - begin


def children(process):
    listed = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True)
    return [int(p) for p in listed.stdout.split()]


def who_may_ask(studio):
    token = studio.address[studio.address.index("/", 8):]
    response, content = studio.ask("GET", "/", cookie=False)
    expect("without a cookie nothing is shown", response.status == 403 and b"page" not in content)
    response, _ = studio.ask("GET", "/?token=wrong", cookie=False)
    expect("a wrong token is refused", response.status == 403)
    response = studio.enter()
    cookie = response.getheader("Set-Cookie") or ""
    expect("the token becomes a cookie", response.status == 303 and response.getheader("Location") == "/")
    expect("the cookie is for the server alone", "HttpOnly" in cookie and "SameSite=Strict" in cookie, cookie)
    response, _ = studio.ask("GET", token, cookie=False)
    expect("the token is good once", response.status == 403)
    response, content = studio.ask("GET", "/")
    expect("with the cookie the page is there", response.status == 200 and b"page" in content)
    policy = response.getheader("Content-Security-Policy") or ""
    expect("no script from elsewhere", "default-src 'none'" in policy and "script-src 'self';" in policy, policy)
    expect("no referrer", response.getheader("Referrer-Policy") == "no-referrer")
    expect("no permission for other pages", response.getheader("Access-Control-Allow-Origin") is None)
    body = json.dumps({"do": "hello"})
    for name, headers in {
            "another page": {"Origin": "http://evil.example"},
            "a page without origin": {"Origin": None},
            "a page of another port": {"Origin": "http://127.0.0.1:1"},
            "a name that points here": {"Host": f"evil.example:{studio.port}"},
            "no host": {"Host": ""},
            "a sandboxed frame": {"Origin": "null"}}.items():
        response, _ = studio.ask("POST", "/api/request?session=a", body, headers)
        expect(f"{name} may not ask", response.status in (400, 403), response.status)
    response, _ = studio.ask("POST", "/api/request?session=a", body, {"Cookie": "maup-studio-1=x"})
    expect("a made-up cookie is refused", response.status == 403)


def paths(studio):
    for path in ["/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "//etc/passwd", "/etc/passwd",
                 "/....//secret.txt", "/index.html/../../secret.txt", "/%00", "/index.html%00.js"]:
        response, content = studio.ask("GET", path)
        expect(f"{path} leads nowhere", b"secret" not in content and b"root:" not in content, content)
    for path in ["../secret.txt", "/etc/passwd", "..%2f..%2fetc%2fpasswd", "a/../../x.lag", ".hidden.lag", "x.txt",
                 "link.lag", "linked/pendulum.lag", "config.lag", "%00.lag", "", "a" * 5000 + ".lag"]:
        response, content = studio.ask("GET", f"/api/file?path={path}")
        expect(f"file {path[:40]!r} is refused", response.status in (403, 404), response.status)
        response, content = studio.ask("PUT", f"/api/file?path={path}", "system x\n")
        expect(f"file {path[:40]!r} is not written", response.status in (403, 404), response.status)


def files(studio, folder):
    _, content = studio.ask("GET", "/api/files")
    listed = json.loads(content)
    expected = ["double_pendulum.lag", "latin.lag", "pendulum.lag", "sub/kepler.lag"]
    expect("models are listed", [f["path"] for f in listed["files"]] == expected, content)
    response, content = studio.ask("GET", "/api/file?path=latin.lag")
    expect("bytes that are no letters are not read", response.status == 415 and b"UTF-8" in content, content)
    _, content = studio.ask("GET", "/api/file?path=pendulum.lag")
    read = json.loads(content)
    expect("a file is read", read["text"] == (folder / "pendulum.lag").read_text())
    changed = read["text"] + "# θ changed\n"
    response, content = studio.ask("PUT", "/api/file?path=pendulum.lag", changed.encode(),
                                   {"If-Match": f'"{read["etag"]}"'})
    expect("a file is saved", response.status == 200 and (folder / "pendulum.lag").read_text() == changed, content)
    response, content = studio.ask("PUT", "/api/file?path=pendulum.lag", b"mine\n", {"If-Match": f'"{read["etag"]}"'})
    told = json.loads(content)
    expect("a file of another tab is not overwritten", response.status == 409 and told["text"] == changed, content)
    expect("it is as it was", (folder / "pendulum.lag").read_text() == changed)
    response, content = studio.ask("PUT", "/api/file?path=pendulum.lag", b"mine\n")
    expect("a new file is not put over an old one", response.status == 409)
    response, content = studio.ask("PUT", "/api/file?path=new.lag", b"system new\n")
    expect("a new file is written", response.status == 200 and (folder / "new.lag").read_text() == "system new\n")
    response, content = studio.ask("PUT", "/api/file?path=big.lag", b"#" * 2_000_000)
    expect("a file beyond all measure is refused", response.status == 413)
    leftovers = [p.name for p in folder.iterdir() if p.suffix != ".lag" and p.is_file()]
    expect("no temporary file is left", leftovers == [], leftovers)


def questions(studio):
    text = (MODELS / "double_pendulum.lag").read_text()
    answer = studio.request("q", **{"do": "equations"})
    expect("without a text there is a sentence", not answer["ok"] and answer["kind"] == "request", answer)
    expect("a text is opened", studio.request("q", **{"do": "open", "text": text})["readable"])
    answer = studio.request("q", **{"do": "equations"})
    expect("the equations are certified", answer["ok"] and answer["certified"], answer)
    for body in ["", "[]", "{", "null", '{"do": 5}', '{"do":"nothing"}', '{"do":"run","frames":"x"}',
                 '{"do":"run","set":{"l1":5}}', '{"do":"run","set":[]}', '{"do":"pose","drag":3}', "{" * 100000,
                 '{"do":"hover","at":-5}', '{"do":"hover","at":1e300}', '{"do":"rename","at":3,"name":"\\u0000"}',
                 '{"do":"open","text":"\\ud800"}', "\xff\xfe", '{"do":"run","budget":1e999}']:
        _, content = studio.ask("POST", "/api/request?session=bad", body.encode("latin-1"))
        answer = json.loads(content.decode().rsplit("data: ", 1)[1])
        expect(f"{body[:40]!r} gets a sentence", isinstance(answer.get("ok"), bool), answer)
    deep = '{"do":' + "[" * 1_400_000 + "]" * 1_400_000 + "}"
    for body in [deep, '{"do":"run","set":' + "[" * 1_000_000 + "]" * 1_000_000 + "}"]:
        _, content = studio.ask("POST", "/api/request?session=deep", body)
        answer = json.loads(content.decode().rsplit("data: ", 1)[1])
        expect("brackets without end get a sentence", answer["ok"] is False and answer["kind"] == "request", answer)
    studio.request("refused", **{"do": "open", "text": text})
    studio.request("refused", **{"do": "open", "text": "#" * 1_100_000})
    expect("a text that is refused leaves the one before", studio.request("refused", **{"do": "equations"})["ok"])
    for child in children(studio.process):
        os.kill(child, signal.SIGKILL)
    answers = [studio.request("refused", **{"do": "equations"})["ok"] for _ in range(2)]
    expect("in a new worker too", answers[1], answers)
    for session in ["", "../x", "a" * 200, "a b"]:
        response, _ = studio.ask("POST", "/api/request?session=" + session.replace(" ", "%20"), '{"do":"hello"}')
        expect(f"session {session[:20]!r} is refused", response.status == 400)
    response, _ = studio.ask("POST", "/api/request?session=big", b"x" * 20_000_000)
    expect("20 MB are refused", response.status == 413, response.status)
    answer = studio.request("big", **{"do": "open", "text": "#" * 2_000_000})
    expect("a text of 2 MB is refused with a sentence", not answer["ok"] and answer["kind"] == "refused", answer)


FOREVER = """system forever
param m = 1 kg, k = 1 N/m
coord x : length
T = 1/2 m x'^2
V = 1/2 k x^2
start x = 1 m
run 1e9 s
output every 1e6 s
"""


def budgets(studio):
    studio.request("slow", **{"do": "open", "text": FOREVER})
    begin = time.time()
    answer = studio.request("slow", **{"do": "run", "budget": 0.5})
    expect("a run without end ends with its budget", time.time() - begin < 3, time.time() - begin)
    expect("it says so", answer["kind"] == "budget" if not answer["ok"] else not answer["ending"]["ok"], answer)
    connection = http.client.HTTPConnection("127.0.0.1", studio.port, timeout=60)
    connection.request("POST", "/api/request?session=slow", json.dumps({"do": "run", "budget": 300}),
                       {"Host": studio.host, "Origin": f"http://{studio.host}", "Cookie": studio.cookie})
    time.sleep(0.5)
    connection.sock.close()
    begin = time.time()
    answer = studio.request("slow", **{"do": "equations"})
    expect("what nobody waits for is given up", answer["ok"] and time.time() - begin < 4, time.time() - begin)
    with concurrent.futures.ThreadPoolExecutor() as pool:
        running = pool.submit(studio.request, "slow", **{"do": "run", "budget": 300})
        time.sleep(0.5)
        begin = time.time()
        studio.ask("POST", "/api/cancel?session=slow", "")
        answer = running.result()
        expect("a cancel is heard", time.time() - begin < 2.5, answer)


def killed(studio):
    text = (MODELS / "pendulum.lag").read_text()
    studio.request("k", **{"do": "open", "text": text})
    for child in children(studio.process):
        os.kill(child, signal.SIGKILL)
    answer = studio.request("k", **{"do": "equations"})
    if not answer["ok"]:  # the answer to the request that met the dead process
        expect("a dead worker is told", answer["kind"] == "internal", answer)
        answer = studio.request("k", **{"do": "equations"})
    expect("a new worker knows the text", answer["ok"] and answer["certified"], answer)
    connection = socket.create_connection(("127.0.0.1", studio.port))
    connection.sendall(b"POST /api/request?session=k HTTP/1.1\r\nHost: ")  # a browser that dies in the middle
    connection.close()
    for garbage in [b"\x00" * 1000, b"GET / HTTP/9.9\r\n\r\n", b"A" * 100000,
                    b"GET " + b"/" * 20000 + b" HTTP/1.1\r\n\r\n"]:
        with socket.create_connection(("127.0.0.1", studio.port)) as connection:
            try:
                connection.sendall(garbage)
            except OSError:
                pass
    expect("it goes on", studio.request("k", **{"do": "hello"})["ok"])


def many(studio):
    text = (MODELS / "pendulum.lag").read_text()

    def one(i):
        studio.request(f"s{i}", **{"do": "open", "text": text})
        return studio.request(f"s{i}", **{"do": "equations"})["certified"]

    begin = time.time()
    with concurrent.futures.ThreadPoolExecutor(100) as pool:
        good = list(pool.map(one, range(100)))
    expect("100 sessions at once", all(good), time.time() - begin)
    print(f"100 sessions: {time.time() - begin:.1f} s")


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    for name in ["pendulum", "double_pendulum"]:
        shutil.copy(MODELS / f"{name}.lag", folder)
    (folder / "sub").mkdir()
    shutil.copy(MODELS / "kepler.lag", folder / "sub")
    (folder / "link.lag").symlink_to("/etc/passwd")
    (folder / "linked").symlink_to(MODELS)
    (folder / ".git").mkdir()
    (folder / ".git" / "config").write_text("secret\n")
    (folder / "config.lag").symlink_to(folder / ".git" / "config")
    (folder / "latin.lag").write_bytes(b"system latin # M\xfcller\n")
    (folder / ".hidden.lag").write_text("system hidden\n")
    studio = Studio(folder)
    try:
        who_may_ask(studio)
        paths(studio)
        files(studio, folder)
        questions(studio)
        budgets(studio)
        killed(studio)
        many(studio)
        second = Studio(folder, "--port", str(studio.port))
        expect("a port in use is told", second.process.wait(timeout=10) == 2)
        expect("with its code", "E0851" in second.process.stderr.read())
        shutil.rmtree(folder)
        response, content = studio.ask("GET", "/api/files")
        expect("a folder that vanished is told", response.status == 404 and b"no longer there" in content, content)
        workers = children(studio.process)
        # As browsers do: the request that starts the worker, and one that lasts, over one connection that is kept.
        kept = http.client.HTTPConnection("127.0.0.1", studio.port, timeout=60)
        headers = {"Host": studio.host, "Origin": f"http://{studio.host}", "Cookie": studio.cookie}
        kept.request("POST", "/api/request?session=last", json.dumps({"do": "open", "text": FOREVER}), headers)
        kept.getresponse().read()
        kept.request("POST", "/api/request?session=last", json.dumps({"do": "run", "budget": 60}), headers)
        time.sleep(0.5)
        code, seconds = studio.end()
        expect("Ctrl-C ends it with 130 within a second", code == 130 and seconds < 1.5, (code, seconds))
        time.sleep(0.2)
        expect("no worker is left", not any(os.path.exists(f"/proc/{w}") for w in workers))
    finally:
        studio.process.kill()
    print("failed: " + ", ".join(failures) if failures else "all as it should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
