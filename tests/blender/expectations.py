# What the tests in Blender share: expectations that are counted, and Blender's importer made to start.
import numpy as np

# Debian 12 has Blender 3.4 beside NumPy 1.24, which no longer has a name that Blender's glTF importer uses.
if not hasattr(np, "bool"):
    np.bool = bool

faults = []
checks = 0


def expect(holds, what):
    global checks
    checks += 1
    if not holds:
        faults.append(what)


def expect_near(found, wanted, tolerance, what):
    found, wanted = np.asarray(found, float), np.asarray(wanted, float)
    if np.size(found) == 0 or np.size(wanted) == 0:
        expect(np.size(found) == np.size(wanted), f"{what}: there is nothing to compare")
        return
    error = np.abs(found - wanted).max()
    expect(error <= tolerance, f"{what}: {error:.3g} apart, {tolerance:.3g} allowed")
