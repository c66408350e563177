"""Vehicle and arm in water, assembled another way: nothing of the recursions or their frames.

The kinetic energy is a sum of J^T M J over the bodies, its forces are those of Euler and Poincare
(vehicle) and of Lagrange (joints), weight and buoyancy are slopes of the potential energy, drag is
summed strip by strip. All slopes are complex steps (Squire and Trapp, SIAM Review 1998), which are
exact to rounding, so everything here must stay analytic: no norm, no conjugate.
"""

import numpy as np

from uvms_dynamics.kernels.drag_table import PER_OCTAVE

STEP = 1e-30


def cross_matrix(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def turn(axis, angle):
    """Homogeneous rotation (4, 4) about x, y or z."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(4, dtype=np.result_type(angle, float))
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def shift(x, y, z):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def mounted(mounting):
    roll, pitch, yaw = np.radians(mounting.rpy_deg)
    return shift(*mounting.position_m) @ turn(2, yaw) @ turn(1, pitch) @ turn(0, roll)


def link_poses(arm, q):
    """The arm's base and its DH frames (n+1, 4, 4) in the body frame."""
    poses = [mounted(arm.base)]
    for joint, angle in zip(arm.joints, q, strict=True):
        along = shift(0.0, 0.0, joint.d_m) @ shift(joint.a_m, 0.0, 0.0)
        step = turn(2, angle + np.radians(joint.offset_deg)) @ along
        poses.append(poses[-1] @ step @ turn(0, np.radians(joint.alpha_deg)))
    return np.array(poses)


def link_jacobian(poses, i):
    """From (nu, q_dot) to the twist (6,) of link i in its own frame."""
    rotation, place = poses[i + 1, :3, :3], poses[i + 1, :3, 3]
    jacobian = np.zeros((6, 5 + len(poses)), dtype=poses.dtype)
    jacobian[:3, :3] = jacobian[3:, 3:6] = np.eye(3)
    jacobian[:3, 3:6] = -cross_matrix(place)
    for j in range(i + 1):
        axis = poses[j, :3, 2]
        jacobian[:3, 6 + j] = np.cross(axis, place - poses[j, :3, 3])
        jacobian[3:, 6 + j] = axis
    return np.concatenate([rotation.T @ jacobian[:3], rotation.T @ jacobian[3:]])


def inertia(body):
    """Rigid and added mass (6, 6) about the origin of the body's frame."""
    lever = cross_matrix(body.cg_m)
    first = body.mass_kg * lever
    second = np.array(body.inertia_kg_m2) - body.mass_kg * lever @ lever
    return np.block([[body.mass_kg * np.eye(3), -first], [first, second]]) + body.added_mass


def mass_matrix(vehicle, q):
    """Sum of J^T M J, and the rotors."""
    poses = link_poses(vehicle.arm, q)
    rotors = [joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints]
    matrix = np.diag(np.concatenate([np.zeros(6), rotors])).astype(poses.dtype)
    matrix[:6, :6] += inertia(vehicle.hull)
    for i, link in enumerate(vehicle.arm.links):
        jacobian = link_jacobian(poses, i)
        matrix += jacobian.T @ inertia(link) @ jacobian
    return matrix


def slope(function, x, direction):
    """Derivative of an analytic function at x along a direction."""
    return np.imag(function(x + 1j * STEP * np.asarray(direction))) / STEP


def inertial_force(vehicle, nu, q, q_dot, acceleration):
    """d/dt dT/dzeta with the terms of the turning body frame, less dT/dq."""
    zeta = np.concatenate([nu, q_dot])
    momentum = mass_matrix(vehicle, q) @ zeta
    force = mass_matrix(vehicle, q) @ acceleration
    force += slope(lambda x: mass_matrix(vehicle, x) @ zeta, q, q_dot)
    for k, unit in enumerate(np.eye(len(q))):
        force[6 + k] -= 0.5 * slope(lambda x: zeta @ mass_matrix(vehicle, x) @ zeta, q, unit)
    v, w, p, h = nu[:3], nu[3:], momentum[:3], momentum[3:6]
    force[:3] += np.cross(w, p)
    force[3:6] += np.cross(w, h) + np.cross(v, p)
    return force


def potential_energy(vehicle, rotation, q):
    """-m g z of each centre of gravity + rho V g z of each centre of buoyancy, origin at z = 0."""
    water, poses = vehicle.environment, link_poses(vehicle.arm, q)
    places = [np.eye(4), *poses[1:]]
    total = 0.0
    for body, pose in zip((vehicle.hull, *vehicle.arm.links), places, strict=True):
        weight = body.mass_kg * water.gravity_m_s2
        lift = water.water_density_kg_m3 * body.volume_m3 * water.gravity_m_s2
        for force, centre in ((weight, body.cg_m), (-lift, body.cb_m)):
            total -= force * (rotation @ (pose[:3, :3] @ centre + pose[:3, 3]))[2]
    return total


def restoring_force(vehicle, rotation, q):
    """Weight and buoyancy (6+n,) ON the system: the fall of the potential energy."""
    net = sum(
        body.mass_kg - vehicle.environment.water_density_kg_m3 * body.volume_m3
        for body in (vehicle.hull, *vehicle.arm.links)
    )
    force = [*(rotation[2] * net * vehicle.environment.gravity_m_s2)]
    for axis in np.eye(3):
        tilted = rotation @ cross_matrix(axis)
        force.append(-slope(lambda x: potential_energy(vehicle, x, q), rotation, tilted))
    for axis in np.eye(len(q)):
        force.append(-slope(lambda x: potential_energy(vehicle, rotation, x), q, axis))
    return np.array(force)


def drag_force(vehicle, nu_r, q, q_dot):
    """Damping of the hull and drag of all links ON the system (6+n,)."""
    zeta, hull = np.concatenate([nu_r, q_dot]), vehicle.hull
    force = np.zeros(len(zeta))
    linear, quadratic = as_matrix(hull.linear_damping), as_matrix(hull.quadratic_damping)
    for i in range(6):
        for j in range(6):
            force[i] -= linear[i, j] * nu_r[j]
            force[i] -= quadratic[i, j] * nu_r[j] ** 2 * np.sign(nu_r[j])
    force[:6] += lift_force(hull.cross_terms, abs(nu_r[0]), nu_r)
    for fin in hull.fins:
        force[:6] += fin_force(vehicle, fin, nu_r)
    poses = link_poses(vehicle.arm, q)
    for i, link in enumerate(vehicle.arm.links):
        jacobian = link_jacobian(poses, i)
        for cylinder in link.drag:
            force += jacobian.T @ cylinder_drag(vehicle, cylinder, jacobian @ zeta)
    return force


def as_matrix(damping):
    return np.diag(damping) if np.ndim(damping) == 1 else np.array(damping)


def lift_force(terms, u, nu):
    """Products with the surge speed, of lift alone."""
    if terms is None:
        return np.zeros(6)
    assert not terms.added_mass_included
    _, v, w, p, q, r = nu
    return u * np.array(
        [
            0.0,
            terms.Y_uv * v + terms.Y_ur * r,
            terms.Z_uw * w + terms.Z_uq * q,
            terms.K_up * p,
            terms.M_uw * w + terms.M_uq * q,
            terms.N_uv * v + terms.N_ur * r,
        ]
    )


def fin_force(vehicle, fin, nu):
    """Lift, drag and stalled normal force of a fin from its angle of attack, by trigonometry."""
    place, span = np.array(fin.position_m), np.cross(fin.normal, fin.chord)
    velocity = nu[:3] + np.cross(nu[3:], place)
    velocity = velocity - span * (span @ velocity)
    setting = np.radians(fin.incidence_deg)
    angle = np.arctan2(velocity @ fin.normal, velocity @ fin.chord) + setting
    plate = np.cos(setting) * np.array(fin.normal) + np.sin(setting) * np.array(fin.chord)
    ratio = (np.sin(angle) / np.sin(np.radians(fin.stall_deg))) ** 8
    attached = 1.0 / (1.0 + ratio)
    slope = 1.0 / (1.0 / (1.8 * np.pi) + 1.0 / (np.pi * fin.aspect_ratio))
    c_lift = attached * slope * 0.5 * np.sin(2.0 * angle)
    c_drag = fin.drag_coefficient + c_lift**2 / (0.9 * np.pi * fin.aspect_ratio)
    c_plate = (1.0 - attached) * fin.plate_drag_coefficient * np.sin(angle)
    speed = np.sqrt(velocity @ velocity)
    upwash = np.cross(span, velocity) / speed  # across the flow, towards -normal where it is ahead
    force = c_lift * upwash - c_drag * velocity / speed - c_plate * plate
    force = 0.5 * vehicle.environment.water_density_kg_m3 * fin.area_m2 * speed**2 * force
    return np.concatenate([force, np.cross(place, force)])


KAPPA = {1: 0.53, 2: 0.58, 5: 0.62, 10: 0.68, 20: 0.74, 40: 0.82, 50: 0.87, 100: 0.98, 200: 1.0}


def end_effect(cylinder):
    """DNV-RP-C205, table 6-2; with one free end the length counts twice, with none as endless."""
    if cylinder.free_ends == 0:
        return 1.0
    slenderness = cylinder.length_m / cylinder.radius_m / cylinder.free_ends
    return np.interp(np.log(slenderness), np.log(list(KAPPA)), list(KAPPA.values()))


def cylinder_drag(vehicle, cylinder, twist):
    """Drag (6,) on a cylinder about its link's origin: across it by strips, and along it."""
    nodes, weights = np.polynomial.legendre.leggauss(cylinder.stations)
    total = np.zeros(6)
    for node, weight in zip(nodes, weights, strict=True):
        width = 0.5 * cylinder.length_m * weight
        r = np.add(cylinder.center_m, 0.5 * cylinder.length_m * node * np.array(cylinder.axis))
        force = width * line_drag(vehicle, cylinder, twist[:3] + np.cross(twist[3:], r))
        total += np.concatenate([force, np.cross(r, force)])
    r = np.array(cylinder.center_m)
    force = side_friction(vehicle, cylinder, twist[:3] + np.cross(twist[3:], r))
    return total + np.concatenate([force, np.cross(r, force)])


def side_friction(vehicle, cylinder, velocity):
    """Friction (3,) along the axis on the side of a whole cylinder, N."""
    water, axis, length = vehicle.environment, np.array(cylinder.axis), cylinder.length_m
    speed = axis @ velocity
    c_f = drag_coefficient(
        vehicle.arm.friction_coefficient, abs(speed) * length / water.kinematic_viscosity_m2_s
    )
    side = np.pi * 2.0 * cylinder.radius_m * length
    return -0.5 * water.water_density_kg_m3 * c_f * side * speed**2 * np.sign(speed) * axis


def line_drag(vehicle, cylinder, velocity):
    """Drag (3,) for a metre of a cylinder, N/m, from the velocity across its axis."""
    water, axis, diameter = vehicle.environment, np.array(cylinder.axis), 2.0 * cylinder.radius_m
    across = np.cross(np.cross(axis, velocity), axis)
    speed = float(np.sqrt(across @ across))
    c_d = drag_coefficient(
        vehicle.arm.drag_coefficient, speed * diameter / water.kinematic_viscosity_m2_s
    )
    return -0.5 * water.water_density_kg_m3 * end_effect(cylinder) * c_d * diameter * speed * across


def drag_coefficient(table, reynolds):
    """C_D or C_f, linear between points even over each doubling of Re, each from the file."""
    if reynolds <= 0.0:
        return table.cd[0]
    octave = 2.0 ** np.floor(np.log2(reynolds))
    low = np.floor((reynolds / octave - 1.0) * PER_OCTAVE)
    ends = octave * (1.0 + np.array([low, low + 1.0]) / PER_OCTAVE)
    return np.interp(reynolds, ends, np.interp(np.log(ends), np.log(table.reynolds), table.cd))


def inverse_dynamics(vehicle, rotation, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Generalized force (6+n,) that makes a motion, relative to the water."""
    force = inertial_force(vehicle, nu_r, q, q_dot, np.concatenate([nu_r_dot, q_ddot]))
    return force - restoring_force(vehicle, rotation, q) - drag_force(vehicle, nu_r, q, q_dot)
