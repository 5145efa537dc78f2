# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""test_sbom.py SOURCE: the bill of materials of two packages names each of them, all that they
depend on and all with which they are compiled, and is the same when it is written again."""
import hashlib
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ABSENT = "no-such-package-of-debian"  # Named as one that isn't installed.
NEEDS = {"tactus-one": ["libc6", "bash", "dash"], "tactus-two": ["tactus-one", ABSENT]}
DEPENDS = {"tactus-one": "libc6 (>= 2.36), bash | dash",
           "tactus-two": f"tactus-one (= 0.2.0), {ABSENT}"}


def make_package(folder, name):
    root = folder / name
    (root / "DEBIAN").mkdir(parents=True)
    (root / "DEBIAN/control").write_text(
        f"Package: {name}\nVersion: 0.2.0\nArchitecture: all\nMaintainer: A <a@example.org>\n"
        f"Depends: {DEPENDS[name]}\nDescription: an example\n")
    deb = folder / f"{name}_0.2.0_all.deb"
    subprocess.run(["dpkg-deb", "--root-owner-group", "--build", root, deb], check=True,
                   stdout=subprocess.DEVNULL)
    return deb


def check(source, folder):
    debs = [make_package(folder, name) for name in NEEDS]
    texts = []
    for output in (folder / "a.spdx.json", folder / "b.spdx.json"):
        subprocess.run([sys.executable, "-B", source / "cmake/debian/sbom.py", source, output,
                        *debs], check=True)
        texts.append(output.read_text())
    assert texts[0] == texts[1], "the bill differs when it is written again"
    bill = json.loads(texts[0])
    assert bill["spdxVersion"] == "SPDX-2.3" and bill["dataLicense"] == "CC0-1.0"
    assert bill["SPDXID"] == "SPDXRef-DOCUMENT" and bill["documentNamespace"].startswith("https://")
    packages = {package["SPDXID"]: package for package in bill["packages"]}
    assert len(packages) == len(bill["packages"]), "an identifier is used twice"
    relations = {(r["spdxElementId"], r["relationshipType"], r["relatedSpdxElement"])
                 for r in bill["relationships"]}
    for one, _, other in relations:
        assert one in packages or one == bill["SPDXID"], one
        assert other in packages, other
    for deb, (name, needs) in zip(debs, NEEDS.items()):
        made = packages[f"SPDXRef-{name}"]
        assert made["versionInfo"] == "0.2.0" and made["licenseDeclared"] == "Apache-2.0"
        assert made["checksums"][0]["checksumValue"] == hashlib.sha256(
            deb.read_bytes()).hexdigest()
        assert (bill["SPDXID"], "DESCRIBES", f"SPDXRef-{name}") in relations
        for need in needs:
            assert (f"SPDXRef-{name}", "DEPENDS_ON", f"SPDXRef-{need}") in relations, need
    version = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "bash"], check=True,
                             capture_output=True, text=True).stdout
    assert packages["SPDXRef-bash"]["versionInfo"] == version
    assert "versionInfo" not in packages[f"SPDXRef-{ABSENT}"]
    with open(source / "cmake/packages.txt", encoding="utf-8") as file:
        tools = [line.split()[0] for line in file if line.strip() and line[0] != "#"]
    assert "libeigen3-dev" in tools
    for tool in tools:
        identifier = "SPDXRef-" + tool.replace("+", "-")
        assert (identifier, "BUILD_DEPENDENCY_OF", "SPDXRef-tactus-two") in relations, tool


def main():
    if not (shutil.which("dpkg-deb") and shutil.which("dpkg-query")):
        print("skipped: dpkg-deb and dpkg-query are missing")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        check(pathlib.Path(sys.argv[1]), pathlib.Path(folder))


main()
