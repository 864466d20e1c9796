"""The registers of a channel, from the IP-XACT of the servo IC: nothing of the map is written down a second time."""

import xml.etree.ElementTree as ElementTree

IPXACT = {"ipxact": "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"}


def number(node, name):
    text = node.findtext(f"ipxact:{name}", namespaces=IPXACT)
    return int(text[2:], 16) if text.startswith("'h") else int(text)


class Register:
    """Byte address 8a + 4 is X:a, 8a is Y:a."""

    def __init__(self, node):
        self.address, x = divmod(number(node, "addressOffset"), 8)
        self.x = x // 4
        self.lsb = {field.findtext("ipxact:name", namespaces=IPXACT): number(field, "bitOffset")
                    for field in node.iterfind("ipxact:field", IPXACT)}

    def word(self, **fields):
        """The word with these values in its fields."""
        return sum(value << self.lsb[name] for name, value in fields.items())

    def bit(self, word, name):
        return word >> self.lsb[name] & 1


def registers(file, block="servo_channel"):
    """{name: Register} of one address block."""
    tree = ElementTree.parse(file)
    found = next(node for node in tree.iterfind(".//ipxact:addressBlock", IPXACT)
                 if node.findtext("ipxact:name", namespaces=IPXACT) == block)
    return {node.findtext("ipxact:name", namespaces=IPXACT): Register(node)
            for node in found.iterfind("ipxact:register", IPXACT)}
