"""Check the system libraries that the Python packages load, and install what is missing where that is allowed.

Open3D's wheel brings neither libusb nor the graphics libraries and does not import without them; Mesa's software driver
draws what the cameras see (without it a slower renderer does). With `--tests` a browser is wanted too, in which the
page is tested. This runs before anything is installed, so it uses the standard library alone.
"""

import ctypes
import glob
import os
import shutil
import subprocess
import sys

PACKAGE_OF_LIBRARY = {
    "libusb-1.0.so.0": "libusb-1.0-0",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libEGL_mesa.so.0": "libegl-mesa0",
    "libX11.so.6": "libx11-6",
}
"""Library to the Debian package that holds it."""
DRIVERS = ("/usr/lib/*/dri/swrast_dri.so", "/usr/lib64/dri/swrast_dri.so", "/usr/lib/*/libgallium*.so")
DRIVER_PACKAGE = "libgl1-mesa-dri"
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
BROWSER_PACKAGE = "chromium"


def missing_packages() -> list[str]:
    """Packages whose library cannot be loaded, whose driver is not there, or whose program is not."""
    missing = []
    if not any(map(glob.glob, DRIVERS)):
        missing.append(DRIVER_PACKAGE)
    if "--tests" in sys.argv[1:] and not any(map(shutil.which, BROWSERS)):
        missing.append(BROWSER_PACKAGE)
    for library, package in PACKAGE_OF_LIBRARY.items():
        try:
            ctypes.CDLL(library)
        except OSError:
            missing.append(package)
    return missing


def main() -> int:
    """Install what is missing as root with apt-get, else print the command; returns the exit code."""
    packages = missing_packages()
    if not packages:
        return 0
    install = ["apt-get", "install", "-y", "--no-install-recommends", *packages]
    if os.geteuid() == 0 and shutil.which("apt-get"):
        print(f"Installing system packages: {' '.join(packages)}", flush=True)
        quiet = {"env": {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}, "stdout": subprocess.DEVNULL}
        updated = subprocess.run(["apt-get", "update"], check=False, **quiet).returncode == 0
        if updated and subprocess.run(install, check=False, **quiet).returncode == 0 and not missing_packages():
            return 0
    print(f"System libraries are missing. Run: sudo apt-get update && sudo {' '.join(install)}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
