# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""sbom.py SOURCE OUTPUT DEB...: writes the bill of materials of these packages (SPDX 2.3, JSON):
each package with its hash, the packages that it depends on, and those of SOURCE/cmake/packages.txt
with which it was compiled, in the versions of this machine. The same packages give the same bytes."""
import email.utils
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import time


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def installed(name):
    """(version, architecture) of a package of this machine; None if it isn't installed."""
    shown = subprocess.run(["dpkg-query", "--show", "--showformat",
                            "${db:Status-Status} ${Version} ${Architecture}\n", name],
                           check=False, capture_output=True, text=True)
    fields = [line.split() for line in shown.stdout.splitlines()]
    return next(((field[1], field[2]) for field in fields if field[0] == "installed"), None)


def dependencies(deb):
    """Names in Depends and Pre-Depends, each alternative by itself."""
    text = ",".join(output_of("dpkg-deb", "--field", deb, field)
                    for field in ("Depends", "Pre-Depends"))
    return sorted({re.match(r"[a-z0-9][a-z0-9+.-]*", part.strip())[0]
                   for part in re.split("[,|]", text) if part.strip()})


def identifier(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def element(name, version=None, architecture=None, **more):
    made = {"SPDXID": identifier(name), "name": name, "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "copyrightText": "NOASSERTION",
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", **more}
    if version:
        made["versionInfo"] = version
        vendor = "tactus" if "checksums" in more else "debian"
        made["externalRefs"] = [{
            "referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
            "referenceLocator": f"pkg:deb/{vendor}/{name.replace('+', '%2B')}@"
                                f"{version.replace('+', '%2B').replace(':', '%3A')}"
                                f"?arch={architecture}"}]
    return made


def product(deb):
    fields = {field: output_of("dpkg-deb", "--field", deb, field)
              for field in ("Package", "Version", "Architecture")}
    digest = hashlib.sha256(deb.read_bytes()).hexdigest()
    return element(fields["Package"], fields["Version"], fields["Architecture"],
                   packageFileName=deb.name, licenseDeclared="Apache-2.0",
                   checksums=[{"algorithm": "SHA256", "checksumValue": digest}])


def used(name):
    found = installed(name)
    return element(name, *found) if found else element(
        name, comment="not installed where the packages were made; its version is open")


def relation(one, kind, other):
    return {"spdxElementId": identifier(one), "relationshipType": kind,
            "relatedSpdxElement": identifier(other)}


def created(source):
    """Time of the newest entry of the change log."""
    text = (source / "cmake/debian/changelog").read_text()
    stamp = email.utils.parsedate_to_datetime(
        re.search(r"^ -- .*>  (.*)$", text, re.MULTILINE)[1]).timestamp()
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(stamp))


def bill(source, debs):
    products = {made["name"]: (made, dependencies(deb)) for deb in debs
                for made in [product(deb)]}
    tools = [line.split()[0] for line in (source / "cmake/packages.txt").read_text().splitlines()
             if line.strip() and not line.startswith("#")]
    others = sorted({name for _, needs in products.values() for name in needs} | set(tools))
    packages = [made for made, _ in products.values()]
    packages += [used(name) for name in others if name not in products]
    relations = [relation("DOCUMENT", "DESCRIBES", name) for name in products]
    relations += [relation(name, "DEPENDS_ON", need)
                  for name, (_, needs) in products.items() for need in needs]
    relations += [relation(tool, "BUILD_DEPENDENCY_OF", name)
                  for name in products for tool in tools]
    document = {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0",
                "SPDXID": "SPDXRef-DOCUMENT", "name": "tactus",
                "creationInfo": {"created": created(source),
                                 "creators": ["Organization: Tactus authors", "Tool: sbom.py"]},
                "packages": packages, "relationships": relations}
    digest = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
    document["documentNamespace"] = f"https://tactus.example.org/spdx/{digest}"
    return document


def main():
    source, output, *debs = map(pathlib.Path, sys.argv[1:])
    if not debs:
        raise SystemExit("sbom.py: no package is given")
    output.write_text(json.dumps(bill(source, sorted(debs)), indent=1) + "\n")


if __name__ == "__main__":
    main()
