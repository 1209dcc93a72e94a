# Three bilinear or elastic storeys beside a leaning column of corotational trusses, which carries the weights of the floors.
# In: b of Steel01, weights in N, height of a storey in m, amplitude of the ground in m/s². Out: one JSON list, the floors' displacements after every tenth step, m.
import json
import math
import sys

import openseespy.opensees as ops

RATIO = float(sys.argv[1])
WEIGHTS = [float(weight) for weight in sys.argv[2].split(",")]
HEIGHT, AMPLITUDE = float(sys.argv[3]), float(sys.argv[4])
MASSES, STIFFNESSES, YIELD_FORCES = [2000.0, 1500.0, 1000.0], [6e5, 4.5e5, 3.5e5], [6e3, 5e3, 4e3]
TIME_STEP, STEPS = 1e-3, 3000

ops.wipe()
ops.model("basic", "-ndm", 2, "-ndf", 2)
ops.node(1, 0.0, 0.0)
ops.fix(1, 1, 1)
ops.uniaxialMaterial("Elastic", 1, 1e13)
ops.timeSeries("Constant", 1)
ops.pattern("Plain", 1, 1)
for floor in range(3):
    node = floor + 2
    ops.node(node, 0.0, (floor + 1) * HEIGHT)
    ops.mass(node, MASSES[floor], 0.0)
    ops.uniaxialMaterial("Steel01", node, YIELD_FORCES[floor], STIFFNESSES[floor], RATIO)
    ops.element("corotTruss", node, node - 1, node, 1.0, 1)
    ops.element("twoNodeLink", 10 + node, node - 1, node, "-mat", node, "-dir", 2, "-orient", 0.0, 1.0, 0.0, -1.0, 0.0, 0.0)
    ops.load(node, 0.0, -WEIGHTS[floor])
ops.constraints("Plain")
ops.numberer("Plain")
ops.system("BandGeneral")
ops.test("NormDispIncr", 1e-11, 50)
ops.algorithm("Newton")
ops.integrator("LoadControl", 1.0)
ops.analysis("Static")
if ops.analyze(1) != 0:
    sys.exit("OpenSees does not converge")
ops.loadConst("-time", 0.0)
ground = [AMPLITUDE * math.sin(9.0 * step * TIME_STEP) for step in range(STEPS + 2)]
ops.timeSeries("Path", 2, "-dt", TIME_STEP, "-values", *ground)
ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
ops.wipeAnalysis()
ops.constraints("Plain")
ops.numberer("Plain")
ops.system("BandGeneral")
ops.test("NormDispIncr", 1e-11, 50)
ops.algorithm("Newton")
ops.integrator("Newmark", 0.5, 0.25)
ops.analysis("Transient")
way = []
for _ in range(STEPS):
    if ops.analyze(1, TIME_STEP) != 0:
        sys.exit("OpenSees does not converge")
    way.append([ops.nodeDisp(floor + 2, 1) for floor in range(3)])
ops.wipe()
print(json.dumps(way[9::10]))
