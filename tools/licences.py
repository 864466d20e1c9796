#!/usr/bin/env python3
"""What a build holds of other people, with licences: licences.py BUILD [FOLDER].

Asks ninja which headers and sources went into `brick`, and the loader which libraries it takes; each must belong to a
row of tools/components.toml. FOLDER gets brick.spdx.json, a list in SPDX 2.3, and the licence text of each component.
Without FOLDER it only looks. The list is a function of the build alone: its time is that of the commit.
"""

import argparse
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import tomllib

from common import GIT, ROOT, finish, skip

TABLE = ROOT / "tools/components.toml"
OURS = "Apache-2.0"
PROGRAMS = ["/usr/bin/"]  # that make sources and are in no product


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def used_files(build):
    """Files outside the tree of which the compiler has read any for `brick`."""
    inputs = output("ninja", "-C", build, "-t", "inputs", "bin/brick").splitlines()
    wanted, found, on = set(inputs), set(inputs), False
    for line in output("ninja", "-C", build, "-t", "deps").splitlines():
        if line.startswith(" "):
            if on:
                found.add(line.strip())
        elif line:
            on = line.split(":")[0] in wanted
    absolute = {os.path.normpath(name) for name in found if name.startswith("/")}
    ours = (f"{ROOT}/", f"{build}/")
    return sorted(name for name in absolute if not name.startswith((*ours, *PROGRAMS)) and ".so" not in name)


def loaded(build):
    """Libraries that the loader takes for it."""
    names = re.findall(r"^\s*(\S+)", output("ldd", build / "bin/brick"), re.M)
    return sorted(pathlib.Path(name).name for name in names if "vdso" not in name)


def owner_of_file(name, components):
    rows = [(len(start), row) for row in components for start in row.get("headers", []) if name.startswith(start)]
    if not rows:
        return None
    length, row = max(rows, key=lambda one: one[0])
    rest = name[length:].split("/")[:-1]
    return row if "folders" not in row or (rest or [""])[0] in row["folders"] else None


def owner_of_library(name, components):
    return next((row for row in components if any(name.startswith(start) for start in row.get("libraries", []))), None)


def used(components, files, libraries):
    """(rows that are used, by name, with their relationship; problems)."""
    found, problems = {row["name"]: "STATIC_LINK" for row in components if row.get("image")}, []
    for names, owner, link in ((files, owner_of_file, "STATIC_LINK"), (libraries, owner_of_library, "DYNAMIC_LINK")):
        for name in names:
            row = owner(name, components)
            if row is None:
                problems.append(f"{name}: of no component; expected a row of tools/components.toml")
            else:
                found[row["name"]] = link
    return found, problems


def version_of(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else "NOASSERTION"


def text_of(row):
    if "source" in row:
        return re.match(r"/\*(.*?)\*/", pathlib.Path(row["source"]).read_text(), re.S)[1].strip() + "\n"
    return pathlib.Path("/usr/share/doc", row.get("text", row["package"]), "copyright").read_text()


def identifier(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.]+", "-", name)


def package(name, version, licence, **more):
    return {"SPDXID": identifier(name), "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": licence, "licenseDeclared": licence,
            "copyrightText": "NOASSERTION", **more}


def commit_time():
    """Seconds: of the environment as reproducible-builds.org says, else of the commit, else of no time at all."""
    done = subprocess.run([*GIT, "-C", ROOT, "log", "-1", "--format=%ct"], capture_output=True, text=True)
    return int(os.environ.get("SOURCE_DATE_EPOCH") or done.stdout.strip() or 0)


def spdx(build, components, links):
    version = re.search(r"^project\(brick VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
    image = hashlib.sha256((build / "bin/turbo.elf").read_bytes()).hexdigest()
    created = datetime.datetime.fromtimestamp(commit_time(), datetime.UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    packages = [package("brick", version, OURS),
                package("turbo.elf", version, OURS, checksums=[{"algorithm": "SHA256", "checksumValue": image}])]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-brick"), ("SPDXRef-brick", "CONTAINS", "SPDXRef-turbo.elf")]
    for row in components:
        if row["name"] in links:
            purl = f"pkg:deb/debian/{row['package']}@{version_of(row['package'])}"
            packages.append(package(row["name"], version_of(row["package"]), row["licence"], externalRefs=[
                {"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": purl}]))
            whole = "SPDXRef-turbo.elf" if row.get("image") else "SPDXRef-brick"
            relations.append((whole, links[row["name"]], identifier(row["name"])))
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
            "name": f"brick-{version}",
            "documentNamespace": f"https://spdx.org/spdxdocs/brick-{version}-{image[:16]}",
            "creationInfo": {"created": created, "creators": ["Tool: tools/licences.py"]}, "packages": packages,
            "relationships": [dict(zip(("spdxElementId", "relationshipType", "relatedSpdxElement"), one, strict=True))
                              for one in relations]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    options = parser.parse_args()
    build = options.build.resolve()
    if missing := [name for name in ("build.ninja", "bin/brick", "bin/turbo.elf") if not (build / name).exists()]:
        skip(f"no {', '.join(missing)} in {build}; what went into it is not known")
    components = tomllib.loads(TABLE.read_text())["component"]
    links, problems = used(components, used_files(build), loaded(build))
    if options.folder:
        options.folder.mkdir(parents=True, exist_ok=True)
        for row in components:
            if row["name"] in links:
                (options.folder / row["name"].replace(" ", "-")).write_text(text_of(row))
        (options.folder / "brick.spdx.json").write_text(json.dumps(spdx(build, components, links), indent=1) + "\n")
    finish(f"licences of {len(links)} components", problems)


if __name__ == "__main__":
    main()
