"""The page of `brick serve --page` in Debian's Chromium: it opens, plots move, a button moves the motor, a limit lamp
lights, the terminal answers; narrow and wide, light and dark; nothing on the console, nothing asked from outside.

usage: page_browser.py BRICK CASE; each CASE is one test. BRICK_PAGE_PNG=FOLDER keeps pictures of it.
"""
import os
import pathlib
import signal
import tempfile
import time

import command
from browser import Browser
from command import check
from page_command import served_page
from served import PATIENCE

# An end switch 3,000 counts up, for all motors.
PLANT = (command.EXAMPLES / "plants" / "dac8.toml").read_text().replace('drive = "torque"', 'drive = "torque"\n'
                                                                        'plus_limit = 3000', 1)
MOTOR_1 = 'document.querySelector("[data-motor=\\"1\\"]")'
LOOKS = [(width, scheme) for width in (1440, 420) for scheme in ("light", "dark")]


class Page(Browser):
    def until(self, expression, what):
        last = time.monotonic() + PATIENCE
        while not self.value(expression):
            if time.monotonic() > last:
                check(False, f"{what}: not {expression}; {self.said} {self.value('JSON.stringify(latest)')}")
            time.sleep(0.05)

    def press(self, label):
        found = self.value(f"[...document.querySelectorAll('button')].filter(b => b.ariaLabel === '{label}').length")
        check(found == 1, f"{found} buttons {label!r}")
        self.value(f"[...document.querySelectorAll('button')].find(b => b.ariaLabel === '{label}').click()")

    def type(self, field, form, text):
        self.value(f"at('{field}').value = '{text}'; at('{form}').requestSubmit()")

    def look(self, width, scheme):
        self.call("Emulation.setScrollbarsHidden", hidden=True)  # their width is cut off in pictures
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])


def lit(text):
    return f"[...{MOTOR_1}.querySelectorAll('.lamp.lit')].some(l => l.textContent === '{text}')"


def plotted(kind):
    """The values that are drawn of motor 1."""
    return f"{MOTOR_1}.querySelector('canvas.{kind}').plotted.filter(v => v !== null)"


def spread(kind):
    return f"(v => Math.max(...v) - Math.min(...v))({plotted(kind)})"


def settled(page):
    """Two frames later, so that what was asked for is drawn."""
    page.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def check_looks(page, folder):
    backs = set()
    for width, scheme in LOOKS:
        page.look(width, scheme)
        page.value("new Promise(done => setTimeout(done, 200))")
        settled(page)
        wide = page.value("document.documentElement.scrollWidth")
        check(wide <= width, f"{width} wide, {scheme}: the page is {wide} wide")
        parts = page.value("[...document.querySelectorAll('section')].every(s => s.clientWidth > 200)")
        check(parts, f"{width} wide, {scheme}: a section is lost")
        small = page.value("[...document.querySelectorAll('canvas')].filter(c => c.clientWidth < 60).length")
        check(small == 0, f"{width} wide: {small} plots of no width")
        backs.add(page.value("getComputedStyle(document.body).backgroundColor"))
        if folder:
            page.picture(pathlib.Path(folder) / f"page-{width}-{scheme}.png")
    check(len(backs) == 2, f"light and dark: {backs}")


def page_in_browser():
    with tempfile.TemporaryDirectory() as folder:
        plant = pathlib.Path(folder) / "limits.toml"
        plant.write_text(PLANT)
        with served_page("--plant", str(plant), "--load", "dac8") as server, Page() as page:
            page.look(1440, "light")
            page.show(server.address)
            page.until(f"{MOTOR_1} && at('link').textContent === 'connected'", "the page is connected")
            check(page.value("document.querySelectorAll('.motor').length") == 8, "eight motors")
            check(page.value(f"{MOTOR_1}.querySelector('.name span').textContent") == "killed", "killed at first")
            check(not page.value(lit("+LIM")), "no limit yet")
            # The terminal answers, keeps what was typed, and shows a refusal.
            page.type("line", "say", "ver")
            page.until("at('said').textContent.includes('1.947')", "the terminal's answer")
            page.type("line", "say", "frob")
            page.until("at('said').querySelector('.refused')?.textContent === 'ERR003'", "a refusal")
            page.value("at('line').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp'}));"
                       "at('line').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp'}))")
            check(page.value("at('line').value") == "ver", "the history of the terminal")
            page.value("at('line').value = ''")
            page.type("line", "say", "#3")  # what all clients address from now on
            for item in ("host.breq", "P1", "#1P", "a b"):
                page.type("item", "add", item)
            page.type("line", "say", "P1=12.5")
            page.until("[...document.querySelectorAll('#watched tr')].map(r => r.cells[1].textContent + ' ' + "
                       "r.cells[2].textContent).slice(0, 2).join() === '0 memory,12.5 port'", "the watch list")
            for place, wanted in ((3, "motor1.actual"), (4, "without blanks")):
                check(page.value(f"document.querySelector('#watched tr:nth-child({place}) td:nth-child(2)').textContent"
                                 f".includes('{wanted}')"), f"row {place} says {wanted}")
            page.type("line", "say", "P1=13")  # the list is asked for once more
            page.until("document.querySelector('#watched tr:nth-child(2) td:nth-child(2)').textContent === '13'", "P1")
            page.type("line", "say", "#")
            page.until("at('said').lastChild.textContent === '3'", "the watch list addresses nothing")
            for _ in range(2):
                page.value("document.querySelector('#watched tr:last-child button').click()")
            # A button moves the motor, the plots move with it.
            page.press("#1 stop, close the loop")
            page.until(f"{MOTOR_1}.querySelector('.name span').textContent === 'in position'", "it is closed")
            set_bits = "[...document.querySelectorAll('#status li.set')].map(l => l.textContent)"
            page.until("at('status-of').value === 'motor 1'", "status words of motor 1")
            shown = page.value(set_bits)
            check("19amplifier enabled" in shown and "0in position" in shown and "18open loop" not in shown, str(shown))
            check(page.value(spread("position")) < 5, "it stands")
            page.press("#1 jog positive")
            page.until(f"parseFloat({MOTOR_1}.querySelector('.plot b').textContent) > 500", "the motor moves")
            settled(page)
            check(page.value(spread("position")) > 400, "the plot of the position stands")
            check(page.value(spread("velocity")) > 1, "the plot of the velocity stands")
            # It runs into its end switch.
            page.until(lit("+LIM"), "the lamp of the limit")
            check(not page.value(lit("\N{MINUS SIGN}LIM")), "the other one")
            page.until(f"{MOTOR_1}.querySelector('.name span').textContent !== 'moves'", "it stops there")
            page.until(plotted("velocity") + ".slice(-20).every(v => Math.abs(v) < 0.5)", "velocity back at zero")
            stopped = page.value(set_bits)
            check("21in the positive limit" in stopped and "11stopped on a limit" in stopped, str(stopped))
            with server.client() as client:
                refused = client.write_lines(["I17=8", "&2DEFINE ROTARY 200", "OPEN ROTARY"] + ["DWELL10"] * 9 + [
                    "CLOSE", "OPEN PROG 5 CLEAR", "LINEAR INC TA100 TS50 TM900", "WHILE(1<2)", "X-2 Y3 Z1",
                    "X2 Y-3 Z-1", "ENDWHILE", "CLOSE", "&1A", "#1J-"])
                check(refused is None, f"line and error {refused}")
                page.until("!" + lit("+LIM"), "it leaves the switch")
                page.press("&1 abort")
                page.until(f"{MOTOR_1}.querySelector('.name span').textContent === 'in position'", "it stands")
                client.command("&1B5R")
                page.until("document.querySelector('[data-system=\"1\"] code').textContent.includes('X')", "the line")
                page.until("document.querySelector('[data-system=\"2\"] .lamp.lit.warn') !== null",
                           "Rotary Buffer Full")
                page.value("new Promise(done => setTimeout(done, 4000))" if "BRICK_PAGE_PNG" in os.environ else "0")
                check_looks(page, os.environ.get("BRICK_PAGE_PNG"))
            check(not page.said, f"the page complains: {page.said}")
            check(all(u.startswith((server.address.split("/?")[0], "data:")) for u in page.asked) and
                  len(page.asked) < 4, f"asks: {page.asked}")


def page_refusals_in_browser():
    """What the terminal and the watch list are refused stands there as a refusal, and what is behind it goes on; motors
    that the board has no axis for are shown as what they are."""
    refusals = "[...at('said').querySelectorAll('.refused')].map(l => l.textContent)"
    with served_page("--board", "geobrick-lv-4") as server, Page() as page:
        page.show(server.address)
        page.until("latest && at('link').textContent === 'connected'", "the page is connected")
        page.type("line", "say", "P1=\u00e4")
        page.until(refusals + ".some(l => l.includes('255 characters of ASCII'))", "no ASCII")
        page.type("item", "add", "P(" + 60 * "(" + ")")  # the controller refuses it, and what is behind it goes on
        page.type("item", "add", "P2")
        page.type("line", "say", "P2=7")
        page.until("document.querySelector('#watched tr:nth-child(2) td:nth-child(2)').textContent === '7'", "P2")
        server.process.send_signal(signal.SIGSTOP)  # so that all of them are there at once
        page.value("for (let i = 0; i < 40; i++) say('P1..200')")
        server.process.send_signal(signal.SIGCONT)
        page.until(refusals + ".some(l => l.includes('16 commands wait'))", "too many")
        page.until("waiting.size === 0", "all are answered")
        page.type("line", "say", "I900=1 I1200=1")
        page.until("document.querySelectorAll('.motor').length === 3", "motors 1, 9 and 12")
        for motor in (9, 12):
            page.value(f"document.querySelector('[data-motor=\"{motor}\"] .name button').click()")
            page.until(f"at('status-of').value === 'motor {motor}'", "its status words")
            check("no channel" in page.value("at('pins').textContent"), f"motor {motor}: its pins")
            shown = page.value("document.body.innerText")
            check(not [word for word in ("undefined", "NaN", "null") if word in shown], shown)
        server.end()
        page.until("at('link').textContent === 'not connected'", "the end")
        page.value("at('said').replaceChildren()")
        page.type("line", "say", "ver")
        page.until(refusals + ".join() === 'not connected'", "nobody there")


def page_read_only_in_browser():
    with served_page("--free", "--page-read-only") as server, Page() as page:
        page.show(server.address)
        page.until("document.querySelectorAll('.motor').length === 1", "the motor that the factory activates (I100)")
        check(page.value("document.querySelectorAll('.keys, #terminal, #said').length") == 0, "buttons or a terminal")
        page.type("item", "add", "host.breq")
        page.until("document.querySelector('#watched td:nth-child(2)').textContent === '0'", "the watch list")
        check(not page.said, f"the page complains: {page.said}")


if __name__ == "__main__":
    globals()[command.CASE]()
