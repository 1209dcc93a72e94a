# A column of one elastic beam-column element with P-Δ, fixed below and guided above, under an axial load and ground motion.
# In: mass in kg, height in m, EI in N m², axial load in N, amplitude of the ground in m/s². Out: one JSON list, the displacement of the
# head after every tenth step, m, in a list each.
import json
import math
import sys

import openseespy.opensees as ops

MASS, HEIGHT, BENDING_STIFFNESS, LOAD, AMPLITUDE = [float(text) for text in sys.argv[1:]]
TIME_STEP, STEPS = 1e-3, 3000

ops.wipe()
ops.model("basic", "-ndm", 2, "-ndf", 3)
ops.node(1, 0.0, 0.0)
ops.node(2, 0.0, HEIGHT)
ops.fix(1, 1, 1, 1)
ops.fix(2, 0, 0, 1)
ops.mass(2, MASS, 0.0, 0.0)
ops.geomTransf("PDelta", 1)
ops.element("elasticBeamColumn", 1, 1, 2, 1.0, 1e13, BENDING_STIFFNESS / 1e13, 1)
ops.timeSeries("Constant", 1)
ops.pattern("Plain", 1, 1)
ops.load(2, 0.0, -LOAD, 0.0)


def analysis(integrator, kind):
    ops.wipeAnalysis()
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-13, 50)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)


analysis(["LoadControl", 1.0], "Static")
if ops.analyze(1) != 0:
    sys.exit("OpenSees does not converge")
ops.loadConst("-time", 0.0)
ground = [AMPLITUDE * math.sin(9.0 * step * TIME_STEP) for step in range(STEPS + 2)]
ops.timeSeries("Path", 2, "-dt", TIME_STEP, "-values", *ground)
ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
analysis(["Newmark", 0.5, 0.25], "Transient")
path = []
for _ in range(STEPS):
    if ops.analyze(1, TIME_STEP) != 0:
        sys.exit("OpenSees does not converge")
    path.append([ops.nodeDisp(2, 1)])
ops.wipe()
print(json.dumps(path[9::10]))
