"""`brick serve` from outside: what clients of the Ethernet port are answered.

usage: serve_acceptance.py BRICK CASE; each CASE is one test.
"""
import command
import served_exchanges
from command import check
from served import served


def serve_requests():
    """The requests that every client uses."""
    with served("--free") as server, server.client() as client:
        check(client.identity == "1.947", client.identity)
        check(client.request(0x40, 0xBF, data=b"ver") == b"1.947\r\x06", "GETRESPONSE")
        check(client.flush() == b"@", "FLUSH")
        check(not client.ready(), "nothing waits")
        check(client.send_line("cid") == b"@", "SENDLINE")
        while not client.ready():
            pass
        check(client.get_buffer() == b"603382\r\x06", "GETBUFFER")
        check(not client.ready(), "it has been fetched")


# covers: CARD-3
def serve_exchanges():
    """The golden exchanges and every command of firmware:11, as `brick exec` plays them."""
    for name, least in (("golden.txt", 100), ("commands.txt", 100)):
        with served("--free") as server, server.client() as client:
            found, compared = served_exchanges.differences(client, name)
            check(not found, "\n".join(found))
            check(compared >= least, f"{name}: {compared} compared, expected {least} or more")


globals()[command.CASE]()
