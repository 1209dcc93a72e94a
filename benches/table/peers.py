"""The peers of `cargo bench --bench table`: the same problems in the tools that laboratories have today.

usage: peers.py installed
       peers.py impact | impact_numba | linear | building STOREYS elastic|bilinear    (prints the processor time of a step, in seconds)
       peers.py study | report FOLDER | long_run FOLDER csv|parquet                   (timed from outside, as a whole process)

A striker of 10 kg at 1 m/s hits 1 kg on a spring of 327.65 N/m, for 0.3 s. A building has storeys of 1500 kg and 2 MN/m under a
triangular ground motion, in steps of 2 ms; its damping is of mass alone.
"""
import importlib
import sys
import time

MASS, STIFFNESS = 1.0, 327.65
STRIKER_MASS, SPEED = 10.0, 1.0
DURATION = 0.3
# Of the spring that stands for a rigid contact: OpenSees has no equations of contact.
CONTACT_STIFFNESS = 1e6


def opensees(degrees):
    """A new model with one degree of freedom a node, and nodes 0 to `degrees`, of which the first is fixed."""
    ops = importlib.import_module("openseespy.opensees")
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    for node in range(degrees + 1):
        ops.node(node, 0.0)
    ops.fix(0, 1)
    return ops


def average_acceleration(ops, system, algorithm):
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system(system)
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm(algorithm)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def struck(ops):
    """Node 1 on its spring, and the striker, node 2."""
    ops.mass(1, MASS)
    ops.mass(2, STRIKER_MASS)
    ops.uniaxialMaterial("Elastic", 1, STIFFNESS)
    ops.element("zeroLength", 1, 0, 1, "-mat", 1, "-dir", 1)
    ops.uniaxialMaterial("ElasticPPGap", 2, CONTACT_STIFFNESS, -1e9, -1e-15)
    ops.element("zeroLength", 2, 2, 1, "-mat", 2, "-dir", 1)
    ops.setNodeVel(2, 1, SPEED, "-commit")
    average_acceleration(ops, "BandGeneral", "Newton")


def time_of_steps(ops, steps, time_step):
    """Of one step [s]."""
    before = time.process_time()
    assert ops.analyze(steps, time_step) == 0
    return (time.process_time() - before) / steps


def impact():
    repeats, steps, total = 50, 3000, 0.0
    for _ in range(repeats):
        ops = opensees(2)
        struck(ops)
        total += time_of_steps(ops, steps, DURATION / steps)
    return total / repeats


def impact_numba():
    """The formula of the paper with a constant stiffness, eight numbers of each step in memory."""
    numba, numpy = importlib.import_module("numba"), importlib.import_module("numpy")

    @numba.njit
    def steps_of(rows, time_step, mass, stiffness, striker_mass, speed):
        half, quarter = 0.5 * time_step, 0.25 * time_step * time_step
        displacement = velocity = acceleration = striker = 0.0
        striker_velocity = speed
        for row in range(rows.shape[0]):
            force = 0.0
            restoring = stiffness * (displacement + time_step * velocity + quarter * acceleration)
            after = -restoring / (mass + quarter * stiffness)
            if striker >= displacement:
                push = striker_mass / time_step * (striker_velocity - velocity) - 0.5 * striker_mass * acceleration
                joined = (push - restoring) / (mass + quarter * stiffness + 0.5 * striker_mass)
                trial = striker_mass / time_step * (striker_velocity - velocity - half * (acceleration + joined))
                if trial > 0.0:
                    force, after = trial, joined
            velocity_after = velocity + half * (acceleration + after)
            displacement += half * (velocity + velocity_after)
            striker_after = striker_velocity - force * time_step / striker_mass
            striker += half * (striker_velocity + striker_after)
            if force > 0.0:
                striker = displacement
            velocity, acceleration, striker_velocity = velocity_after, after, striker_after
            rows[row, 0] = (row + 1) * time_step
            rows[row, 1] = displacement
            rows[row, 2] = velocity
            rows[row, 3] = acceleration
            rows[row, 4] = striker
            rows[row, 5] = striker_velocity
            rows[row, 6] = force
            rows[row, 7] = restoring

    repeats, steps = 2000, 3000
    rows = numpy.zeros((steps, 8))
    numbers = (DURATION / steps, MASS, STIFFNESS, STRIKER_MASS, SPEED)
    steps_of(rows, *numbers)
    before = time.process_time()
    for _ in range(repeats):
        steps_of(rows, *numbers)
    return (time.process_time() - before) / (repeats * steps)


def linear():
    ops = opensees(1)
    ops.mass(1, MASS)
    ops.uniaxialMaterial("Elastic", 1, STIFFNESS)
    ops.element("zeroLength", 1, 0, 1, "-mat", 1, "-dir", 1)
    # Per mass [1/s].
    ops.rayleigh(2.0, 0.0, 0.0, 0.0)
    ops.setNodeDisp(1, 1, 0.1, "-commit")
    average_acceleration(ops, "BandSPD", "Linear")
    return time_of_steps(ops, 300_000, 1e-3)


def building(storeys, material):
    ops = opensees(storeys)
    if material == "elastic":
        ops.uniaxialMaterial("Elastic", 1, 2e6)
    else:
        ops.uniaxialMaterial("Steel01", 1, 2e4, 2e6, 0.05)
    for storey in range(1, storeys + 1):
        ops.mass(storey, 1500.0)
        ops.element("zeroLength", storey, storey - 1, storey, "-mat", 1, "-dir", 1)
    ops.rayleigh(0.5, 0.0, 0.0, 0.0)
    ops.timeSeries("Triangle", 1, 0.0, 1e9, 0.5, "-factor", 10.0)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    average_acceleration(ops, "ProfileSPD", "Linear" if material == "elastic" else "Newton")
    return time_of_steps(ops, 300_000 // (storeys + 5), 2e-3)


def study():
    """The largest displacement of 10,000 impacts at once, in steps of 0.1 ms."""
    numpy = importlib.import_module("numpy")
    runs, steps = 10_000, 3000
    time_step = DURATION / steps
    half, quarter = 0.5 * time_step, 0.25 * time_step * time_step
    speed = numpy.linspace(0.8, 1.2, runs)
    mass = numpy.linspace(0.9, 1.1, runs)
    free = mass + quarter * STIFFNESS
    joined = free + 0.5 * STRIKER_MASS
    per_step = STRIKER_MASS / time_step
    displacement, velocity, acceleration, striker, largest = (numpy.zeros(runs) for _ in range(5))
    striker_velocity = speed.copy()
    for _ in range(steps):
        restoring = STIFFNESS * (displacement + time_step * velocity + quarter * acceleration)
        push = per_step * (striker_velocity - velocity) - 0.5 * STRIKER_MASS * acceleration
        together = (push - restoring) / joined
        force = per_step * (striker_velocity - velocity - half * (acceleration + together))
        touches = (striker >= displacement) & (force > 0.0)
        after = numpy.where(touches, together, -restoring / free)
        force = numpy.where(touches, force, 0.0)
        velocity_after = velocity + half * (acceleration + after)
        displacement = displacement + half * (velocity + velocity_after)
        striker_after = striker_velocity - force / per_step
        striker = numpy.where(touches, displacement, striker + half * (striker_velocity + striker_after))
        velocity, acceleration, striker_velocity = velocity_after, after, striker_after
        numpy.maximum(largest, displacement, out=largest)
    assert 0.1 < largest.min() < largest.max() < 0.3


COLUMNS = ("time", "displacement", "velocity", "acceleration", "striker_displacement", "striker_velocity", "contact_force")


def recorded(steps):
    """An impact in OpenSees, with seven numbers read back after each step."""
    ops = opensees(2)
    struck(ops)
    columns = {name: [] for name in COLUMNS}
    for step in range(1, steps + 1):
        assert ops.analyze(1, DURATION / steps) == 0
        row = (
            step * DURATION / steps,
            ops.nodeDisp(1, 1),
            ops.nodeVel(1, 1),
            ops.nodeAccel(1, 1),
            ops.nodeDisp(2, 1),
            ops.nodeVel(2, 1),
            -STRIKER_MASS * ops.nodeAccel(2, 1),
        )
        for name, number in zip(COLUMNS, row):
            columns[name].append(number)
    return columns


def report(folder):
    """3000 steps, a CSV table and a figure of two panels."""
    pandas, matplotlib = importlib.import_module("pandas"), importlib.import_module("matplotlib")
    matplotlib.use("Agg")
    pyplot = importlib.import_module("matplotlib.pyplot")
    columns = recorded(3000)
    pandas.DataFrame(columns).to_csv(folder + "/impact.csv", index=False)
    figure, panels = pyplot.subplots(1, 2, figsize=(10, 4))
    for panel, name in zip(panels, ("displacement", "striker_velocity")):
        panel.plot(columns["time"], columns[name])
        panel.set_xlabel("time (s)")
        panel.set_ylabel(name)
    figure.savefig(folder + "/impact.png", dpi=150)


def long_run(folder, table):
    """300,000 steps and a table."""
    frame = importlib.import_module("polars").DataFrame(recorded(300_000))
    path = folder + "/impact." + table
    if table == "csv":
        frame.write_csv(path)
    else:
        frame.write_parquet(path)


def installed():
    """The modules that are there, one a line."""
    for module in ("openseespy.opensees", "numpy", "numba", "pandas", "matplotlib", "polars"):
        try:
            importlib.import_module(module)
        except Exception:  # OpenSees raises RuntimeError where a library of the system is missing.
            continue
        print(module)


case, arguments = sys.argv[1], sys.argv[2:]
if case == "building":
    arguments[0] = int(arguments[0])
found = {
    function.__name__: function
    for function in (installed, impact, impact_numba, linear, building, study, report, long_run)
}[case](*arguments)
if found is not None:
    print(found)
