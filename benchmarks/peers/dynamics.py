"""Equations of motion in whatever symbols: the formulations that an experienced user of a generator would write.

A number zero or one is never multiplied, so that the generators start from expressions without idle terms.
"""

from scenes import BARS, GRAVITY, INS


def number(value):
    return isinstance(value, (int, float))


def mul(a, b):
    if number(a) and number(b):
        return a * b
    for one, other in ((a, b), (b, a)):
        if number(one):
            if one == 0.0:
                return 0.0
            if one == 1.0:
                return other
            if one == -1.0:
                return -other
    return a * b


def add(a, b):
    if number(a) and a == 0.0:
        return b
    if number(b) and b == 0.0:
        return a
    return a + b


def sub(a, b):
    if number(b) and b == 0.0:
        return a
    return -b if number(a) and a == 0.0 else a - b


def total(terms):
    result = 0.0
    for term in terms:
        result = add(result, term)
    return result


def plus(a, b):
    return [add(x, y) for x, y in zip(a, b)]


def cross(a, b):
    return [sub(mul(a[i], b[j]), mul(a[j], b[i])) for i, j in ((1, 2), (2, 0), (0, 1))]


def skew(a):
    return [[0.0, sub(0.0, a[2]), a[1]], [a[2], 0.0, sub(0.0, a[0])], [sub(0.0, a[1]), a[0], 0.0]]


def transposed(a):
    return [list(row) for row in zip(*a)]


def product(a, b):
    return [[total(mul(x, y) for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def apply(a, vector):
    return [total(mul(x, y) for x, y in zip(row, vector)) for row in a]


def matrices(combine, a, b):
    return [[combine(x, y) for x, y in zip(*rows)] for rows in zip(a, b)]


def rotated(turn, symmetric):
    """The symmetric matrix T S Tᵀ, each element once."""
    half = product(turn, symmetric)
    upper = {
        (i, j): total(mul(half[i][k], turn[j][k]) for k in range(3)) for i in range(3) for j in range(i, 3)
    }
    return [[upper[min(i, j), max(i, j)] for j in range(3)] for i in range(3)]


def mirrored(matrix):
    """A matrix known to be symmetric, by its upper half."""
    size = range(len(matrix))
    return [[matrix[min(i, j)][max(i, j)] for j in size] for i in size]


class Hinge:
    """The frame of a link in that of the link before."""

    def __init__(self, link, angle, functions):
        sine, cosine = functions.sin(angle), functions.cos(angle)
        j, k = (link.axis + 1) % 3, (link.axis + 2) % 3
        turn = [[float(i == l) for l in range(3)] for i in range(3)]
        turn[j][j], turn[j][k], turn[k][j], turn[k][k] = cosine, -sine, sine, cosine
        # Vectors are turned in two steps, which is cheaper than by the product.
        self.fixed, self.moving = link.turn, turn
        self.place = link.place
        self.turn = product(link.turn, turn)

    def down(self, vector):
        return apply(transposed(self.moving), apply(transposed(self.fixed), vector))

    def up(self, vector):
        return apply(self.fixed, apply(self.moving, vector))

    def tensor_up(self, symmetric):
        return rotated(self.fixed, rotated(self.moving, symmetric))

    def matrix_up(self, matrix):
        for turn in (self.moving, self.fixed):
            matrix = product(product(turn, matrix), transposed(turn))
        return matrix


def rigid(link):
    """Mass, first moment and moment of inertia about the link's origin, and what of it is in skew matrices."""
    moment = [link.mass * c for c in link.centre]
    square = sum(c * c for c in link.centre)
    inertia = [
        [
            link.inertia[i][j] + link.mass * ((square if i == j else 0.0) - link.centre[i] * link.centre[j])
            for j in range(3)
        ]
        for i in range(3)
    ]
    return link.mass, moment, inertia


def momentum(link, turning, sliding):
    mass, moment, inertia = rigid(link)
    angular = plus(apply(inertia, turning), cross(moment, sliding))
    linear = plus([mul(mass, v) for v in sliding], cross(turning, moment))
    return angular, linear


def velocities(chain, hinges, rates):
    turning, sliding, found = [0.0] * 3, [0.0] * 3, []
    for link, hinge, rate in zip(chain.links, hinges, rates):
        sliding = hinge.down(plus(sliding, cross(turning, hinge.place)))
        turning = hinge.down(turning)
        turning[link.axis] = add(turning[link.axis], rate)
        found.append((turning, sliding))
    return found


def biased(link, turning, sliding):
    """Force that the link needs to go on without acceleration: V ×* I V."""
    angular, linear = momentum(link, turning, sliding)
    return plus(cross(turning, angular), cross(sliding, linear)), cross(turning, linear)


def relative(link, rate, turning, sliding):
    """Acceleration by the hinge's own rate: V × S q̇."""
    axis = [0.0] * 3
    axis[link.axis] = rate
    return cross(turning, axis), cross(sliding, axis)


def articulated(chain, angles, rates, torques, functions):
    """Accelerations by articulated bodies, from the leaf to the base."""
    hinges = [Hinge(link, angle, functions) for link, angle in zip(chain.links, angles)]
    speeds = velocities(chain, hinges, rates)
    last = len(hinges) - 1
    kept = [None] * (last + 1)
    inertia, force = None, None
    for number in range(last, -1, -1):
        link, hinge, (turning, sliding) = chain.links[number], hinges[number], speeds[number]
        mass, moment, tensor = rigid(link)
        own = (tensor, skew(moment), [[mass if i == j else 0.0 for j in range(3)] for i in range(3)])
        bias = biased(link, turning, sliding)
        if inertia:
            own = tuple(matrices(add, a, b) for a, b in zip(own, inertia))
            bias = plus(bias[0], force[0]), plus(bias[1], force[1])
        top, mixed, bottom = own
        axis = link.axis
        reach = [top[i][axis] for i in range(3)], [mixed[axis][i] for i in range(3)]
        inverse = 1.0 / reach[0][axis]
        effort = sub(torques[number], bias[0][axis])
        change = relative(link, rates[number], turning, sliding)
        scaled = [mul(inverse, x) for x in reach[0]], [mul(inverse, x) for x in reach[1]]
        kept[number] = (hinge, scaled, mul(effort, inverse), change)
        if number == 0:
            break

        def less(block, left, right):
            return [[sub(block[i][j], mul(left[i], right[j])) for j in range(3)] for i in range(3)]

        top = mirrored(less(top, reach[0], scaled[0]))
        mixed = less(mixed, reach[0], scaled[1])
        bottom = mirrored(less(bottom, reach[1], scaled[1]))
        # Nothing is left along the hinge.
        for i in range(3):
            top[i][axis] = top[axis][i] = mixed[axis][i] = 0.0
        moment = plus(plus(apply(top, change[0]), apply(mixed, change[1])), plus(bias[0], [mul(effort, x) for x in scaled[0]]))
        thrust = plus(
            plus(apply(transposed(mixed), change[0]), apply(bottom, change[1])),
            plus(bias[1], [mul(effort, x) for x in scaled[1]]),
        )
        top, mixed, bottom = hinge.tensor_up(top), hinge.matrix_up(mixed), hinge.tensor_up(bottom)
        shift = skew(hinge.place)
        moved = matrices(add, mixed, product(shift, bottom))
        top = matrices(sub, matrices(add, top, product(shift, transposed(moved))), product(mixed, shift))
        inertia = mirrored(top), moved, bottom
        thrust = hinge.up(thrust)
        force = plus(hinge.up(moment), cross(hinge.place, thrust)), thrust
    turning, sliding, found = [0.0] * 3, [0.0, 0.0, GRAVITY], []
    for link, (hinge, scaled, effort, change) in zip(chain.links, kept):
        sliding = plus(hinge.down(plus(sliding, cross(turning, hinge.place))), change[1])
        turning = plus(hinge.down(turning), change[0])
        pull = total(mul(a, b) for a, b in zip(scaled[0] + scaled[1], turning + sliding))
        found.append(sub(effort, pull))
        turning = list(turning)
        turning[link.axis] = add(turning[link.axis], found[-1])
    return found


def inverse_dynamics(chain, hinges, rates, accelerations):
    """Torques by recursive Newton and Euler."""
    turning, sliding, forces = [0.0] * 3, [0.0, 0.0, GRAVITY], []
    speeds = velocities(chain, hinges, rates)
    for number, (link, hinge) in enumerate(zip(chain.links, hinges)):
        change = relative(link, rates[number], *speeds[number])
        sliding = plus(hinge.down(plus(sliding, cross(turning, hinge.place))), change[1])
        turning = plus(hinge.down(turning), change[0])
        turning[link.axis] = add(turning[link.axis], accelerations[number])
        bias, rate = biased(link, *speeds[number]), momentum(link, turning, sliding)
        forces.append((plus(bias[0], rate[0]), plus(bias[1], rate[1])))
    torques, moment, thrust = [None] * len(forces), None, None
    for number in range(len(forces) - 1, -1, -1):
        own = forces[number]
        if moment:
            own = plus(own[0], moment), plus(own[1], thrust)
        torques[number] = own[0][chain.links[number].axis]
        thrust = hinges[number].up(own[1])
        moment = plus(hinges[number].up(own[0]), cross(hinges[number].place, thrust))
    return torques


def mass_matrix(chain, hinges):
    """By composite bodies, the lower triangle."""
    count = len(hinges)
    matrix = [[0.0] * count for _ in range(count)]
    composite = None
    for number in range(count - 1, -1, -1):
        mass, moment, inertia = rigid(chain.links[number])
        if composite:
            mass, moment = mass + composite[0], plus(moment, composite[1])
            inertia = matrices(add, inertia, composite[2])
        axis = chain.links[number].axis
        matrix[number][number] = inertia[axis][axis]
        unit = [float(i == axis) for i in range(3)]
        torque, force = [row[axis] for row in inertia], cross(unit, moment)
        for before in range(number, 0, -1):
            force = hinges[before].up(force)
            torque = plus(hinges[before].up(torque), cross(hinges[before].place, force))
            matrix[number][before - 1] = torque[chain.links[before - 1].axis]
        hinge = hinges[number]
        moment, inertia = hinge.up(moment), hinge.tensor_up(inertia)
        shift, first = skew(hinge.place), skew(moment)
        moved = matrices(add, product(shift, first), product(first, shift))
        moved = matrices(add, moved, [[mul(mass, x) for x in row] for row in product(shift, shift)])
        inertia = mirrored(matrices(sub, inertia, moved))
        composite = mass, plus(moment, [mass * x for x in hinge.place]), inertia
    return matrix


def factorised(matrix):
    """L and the reciprocals of D with L D Lᵀ the symmetric matrix, of which the lower triangle is read."""
    count = len(matrix)
    lower, scaled = ([[0.0] * count for _ in range(count)] for _ in range(2))
    inverse = [None] * count
    for j in range(count):
        for i in range(j, count):
            scaled[i][j] = sub(matrix[i][j], total(mul(lower[i][k], scaled[j][k]) for k in range(j)))
        inverse[j] = 1.0 / scaled[j][j]
        for i in range(j + 1, count):
            lower[i][j] = mul(scaled[i][j], inverse[j])
    return lower, inverse


def solved(factors, right):
    lower, inverse = factors
    count = len(right)
    found = list(right)
    for i in range(count):
        for k in range(i):
            found[i] = sub(found[i], mul(lower[i][k], found[k]))
    found = [mul(x, y) for x, y in zip(found, inverse)]
    for i in range(count - 1, -1, -1):
        for k in range(i + 1, count):
            found[i] = sub(found[i], mul(lower[k][i], found[k]))
    return found


def composite(chain, angles, rates, torques, functions):
    """Accelerations by the mass matrix, factorised densely."""
    hinges = [Hinge(link, angle, functions) for link, angle in zip(chain.links, angles)]
    bias = inverse_dynamics(chain, hinges, rates, [0.0] * len(rates))
    return solved(factorised(mass_matrix(chain, hinges)), [sub(a, b) for a, b in zip(torques, bias)])


def chain_derivative(chain, accelerations):
    """ẋ of x = (angles, rates) by one of the two ways above."""

    def derivative(x, u, functions):
        count = len(chain.links)
        angles, rates = x[:count], x[count:]
        torques = [torque - chain.damping * rate for torque, rate in zip(u, rates)]
        return list(rates) + accelerations(chain, angles, rates, torques, functions)

    return derivative


def ins(in_sequence):
    """ẋ of the inertial navigation system; vectors are turned gimbal by gimbal, or by matrices."""

    def derivative(x, u, functions):
        hull, body, angles = x[0:3], x[3:6], x[6:9]
        (s1, s2, s3), (c1, c2, c3) = ([f(a) for a in angles] for f in (functions.sin, functions.cos))
        fuselage = [h / i for h, i in zip(hull, INS["fuselage"])]
        platform = [b / INS["platform"] for b in body]
        about_x = [[1.0, 0.0, 0.0], [0.0, c1, -s1], [0.0, s1, c1]]
        about_y = [[c2, 0.0, s2], [0.0, 1.0, 0.0], [-s2, 0.0, c2]]
        about_z = [[c3, -s3, 0.0], [s3, c3, 0.0], [0.0, 0.0, 1.0]]
        spring = lambda rates: [-(INS["stiffness"] * a + INS["damping"] * r) for a, r in zip(angles, rates)]
        if in_sequence:
            # In the frame behind gimbal 1 the Jacobian is [[1, 0, s2], [0, 1, 0], [0, 0, c2]].
            seen = apply(about_y, apply(about_z, platform))
            gap = [a - b for a, b in zip(seen, apply(transposed(about_x), fuselage))]
            inverse = 1.0 / c2
            third = gap[2] * inverse
            rates = [gap[0] - s2 * third, gap[1], third]
            torque = spring(rates)
            moment = [torque[0], torque[1], (torque[2] - s2 * torque[0]) * inverse]
            reaction = apply(about_x, moment)
            driven = apply(transposed(about_z), apply(transposed(about_y), moment))
        else:
            turn = product(product(about_x, about_y), about_z)
            gap = [a - b for a, b in zip(apply(turn, platform), fuselage)]
            # The inverse of [[1, 0, s2], [0, c1, −c2 s1], [0, s1, c1 c2]].
            tangent = s2 / c2
            inverse = [[1.0, s1 * tangent, -c1 * tangent], [0.0, c1, s1], [0.0, -s1 / c2, c1 / c2]]
            rates = apply(inverse, gap)
            reaction = apply(transposed(inverse), spring(rates))
            driven = apply(transposed(turn), reaction)
        gyroscopic = cross(fuselage, hull)
        turned = [u[i] - INS["drag"] * fuselage[i] - reaction[i] - gyroscopic[i] for i in range(3)]
        return turned + driven + rates

    return derivative


def fourbar(eliminated):
    """ẋ of the four-bar: by its multipliers, or with the closed loop solved for the rates that the crank's leads to."""

    def derivative(x, u, functions):
        (l1, l2, l3), (m1, m2, m3), damping = BARS["lengths"], BARS["masses"], BARS["damping"]
        turns, rates = [x[0], x[0] + x[1], x[2]], [x[3], x[3] + x[4], x[5]]
        sines, cosines = ([f(a) for a in turns] for f in (functions.sin, functions.cos))
        squares = [rate * rate for rate in rates]
        coupling = m2 * l1 * l2 / 2.0
        between = cosines[0] * cosines[1] + sines[0] * sines[1]
        swing = coupling * (sines[0] * cosines[1] - cosines[0] * sines[1])
        diagonal = [(m1 / 3.0 + m2) * l1 * l1, m2 * l2 * l2 / 3.0, m3 * l3 * l3 / 3.0]
        across = coupling * between
        weights = [GRAVITY * (m1 / 2.0 + m2) * l1, GRAVITY * m2 * l2 / 2.0, GRAVITY * m3 * l3 / 2.0]
        forces = [
            u[0] - damping * x[3] + damping * x[4] - swing * squares[1] + weights[0] * cosines[0],
            swing * squares[0] - damping * x[4] + weights[1] * cosines[1],
            weights[2] * cosines[2] - damping * x[5],
        ]
        lengths = [l1, l2, -l3]
        closing = [[-l * s for l, s in zip(lengths, sines)], [l * c for l, c in zip(lengths, cosines)]]
        right = [
            total(l * c * s for l, c, s in zip(lengths, cosines, squares)),
            total(l * c * s for l, c, s in zip(lengths, sines, squares)),
        ]
        if eliminated:
            # Both other accelerations are `ratio` times that of the crank, plus `rest`.
            inverse = 1.0 / (closing[0][1] * closing[1][2] - closing[0][2] * closing[1][1])
            solve = lambda a, b: [
                (closing[1][2] * a - closing[0][2] * b) * inverse,
                (closing[0][1] * b - closing[1][1] * a) * inverse,
            ]
            ratio = solve(-closing[0][0], -closing[1][0])
            rest = solve(*right)
            inertia = diagonal[0] + ratio[0] * (2.0 * across + ratio[0] * diagonal[1]) + ratio[1] * ratio[1] * diagonal[2]
            force = (
                forces[0]
                - across * rest[0]
                + ratio[0] * (forces[1] - diagonal[1] * rest[0])
                + ratio[1] * (forces[2] - diagonal[2] * rest[1])
            )
            first = force / inertia
            found = [first, ratio[0] * first + rest[0], ratio[1] * first + rest[1]]
        else:
            determinant = 1.0 / (diagonal[0] * diagonal[1] - across * across)

            def light(vector):
                return [
                    (diagonal[1] * vector[0] - across * vector[1]) * determinant,
                    (diagonal[0] * vector[1] - across * vector[0]) * determinant,
                    vector[2] / diagonal[2],
                ]

            free, reach = light(forces), [light(row) for row in closing]
            dot = lambda a, b: total(p * q for p, q in zip(a, b))
            a, b, c = dot(closing[0], reach[0]), dot(closing[0], reach[1]), dot(closing[1], reach[1])
            first, second = (right[i] - dot(closing[i], free) for i in range(2))
            inverse = 1.0 / (a * c - b * b)
            pulls = [(c * first - b * second) * inverse, (a * second - b * first) * inverse]
            found = [free[i] + reach[0][i] * pulls[0] + reach[1][i] * pulls[1] for i in range(3)]
        return [x[3], x[4], x[5], found[0], found[1] - found[0], found[2]]

    return derivative
