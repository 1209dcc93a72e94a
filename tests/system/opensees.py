# A mass on a specimen that somebody else holds: OpenSees integrates, and asks the server at a port for the force.
# In: the port. Out: one JSON list, the displacement after each step, m.
import json
import sys

import openseespy.opensees as ops

MASS, VELOCITY, TIME_STEP, STEPS = 20.0, 0.07, 1e-3, 30

ops.wipe()
ops.model("basic", "-ndm", 1, "-ndf", 1)
ops.node(1, 0.0)
ops.node(2, 0.0)
ops.fix(1, 1)
ops.mass(2, MASS)
ops.element("genericClient", 1, "-node", 2, "-dof", 1, "-server", int(sys.argv[1]), "127.0.0.1")
ops.setNodeVel(2, 1, VELOCITY, "-commit")
ops.constraints("Plain")
ops.numberer("Plain")
ops.system("BandGeneral")
ops.test("NormDispIncr", 1e-10, 10)
ops.algorithm("Linear")
ops.integrator("NewmarkExplicit", 0.5)
ops.analysis("Transient")
way = []
for _ in range(STEPS):
    if ops.analyze(1, TIME_STEP) != 0:
        sys.exit("OpenSees does not converge")
    way.append(ops.nodeDisp(2, 1))
ops.wipe()
print(json.dumps(way))
