"""Constants of `sine.rs` and `exponential.rs` in `mbg-runtime/src`: python3 tools/constants.py (needs mpmath).

With z = y², sin y = y + y z S(z) and cos y = 1 - z/2 + z² C(z) on |y| <= pi/4. S and C are the minimax polynomials for
the error in sin y relative to sin y, and for the absolute error in cos y, by Remez' exchange. Coefficients are rounded
one at a time, the lowest first, and the rest is fitted again, so that rounding one is made good by the others.
pi/2 is cut into parts of so few bits that the multiples in use are exact, and a last one in full; for a fused
multiply-add, into parts in full.

exp r = 1 + r + r² E(r) on |r| <= ln(2) / 2, E the minimax polynomial for the relative error of exp r. ln 2 is cut as pi/2.
"""

from mpmath import cos, exp, expm1, floor, log, lu_solve, matrix, mp, mpf, pi, sin

mp.prec = 300
WIDER = 1 + mpf(2) ** -20
SQUARES = mpf(2) ** -30, (pi / 4 * WIDER) ** 2
AROUND = -log(2) / 2 * WIDER, log(2) / 2 * WIDER


def remez(target, weight, powers, within):
    """Coefficients at `powers` that make the largest weight(z) |target(z) - p(z)| within a range smallest, and that."""
    start, edge = within
    count = len(powers) + 1
    chebyshev = [(1 - cos(pi * k / (count - 1))) / 2 for k in range(count)]
    points = [start + (edge - start) * x for x in chebyshev]
    # Nothing weighs at zero.
    points = [x if abs(x) > edge / 10**9 else edge / 20 for x in points]
    for _ in range(30):
        rows = [[z**p for p in powers] + [(-1) ** k / weight(z)] for k, z in enumerate(points)]
        solution = lu_solve(matrix(rows), matrix([target(z) for z in points]))
        coefficients = list(solution)[:-1]

        def error(z):
            return weight(z) * (target(z) - sum(c * z**p for c, p in zip(coefficients, powers)))

        grid = [start + (edge - start) * (1 - cos(pi * k / 400)) / 2 for k in range(401)]
        values = [error(z) for z in grid]
        found, best = [], 0
        for k, value in enumerate(values):
            if found and (value > 0) == (values[found[-1]] > 0):
                if abs(value) > abs(values[found[-1]]):
                    found[-1] = k
            else:
                found.append(k)
        largest = max(abs(v) for v in values)
        if len(found) < count:
            break
        points = [grid[k] for k in found[:count]]
        if largest <= abs(solution[count - 1]) * (1 + mpf(10) ** -3):
            break
    return coefficients, largest


def rounded(value, bits):
    """The nearest number of so many bits."""
    exponent = floor(log(abs(value), 2)) + 1 - bits
    return floor(value / mpf(2) ** exponent + mpf(1) / 2) * mpf(2) ** exponent


def polynomial(target, weight, degree, bits, within):
    """Rounded coefficients from the lowest, and the largest weighted error with them."""
    fixed = []
    for power in range(degree + 1):
        rest = lambda z: target(z) - sum(c * z**p for p, c in enumerate(fixed))
        coefficients, _ = remez(rest, weight, list(range(power, degree + 1)), within)
        fixed.append(rounded(coefficients[0], bits))
    start, edge = within
    grid = [start + (edge - start) * mpf(k) / 2000 for k in range(2001)]
    return fixed, max(abs(weight(z) * (target(z) - sum(c * z**p for p, c in enumerate(fixed)))) for z in grid)


def parts(whole, bits, count, full):
    """A number as so many parts of so few bits, and one in full."""
    rest, found = whole, []
    for width in [bits] * count + [full]:
        found.append(rounded(rest, width))
        rest -= found[-1]
    return found, rest


def sine(z):
    return (sin(z**0.5) / z**0.5 - 1) / z


def cosine(z):
    return (cos(z**0.5) - 1 + z / 2) / z**2


def power(r):
    return (expm1(r) - r) / r**2 if abs(r) > mpf(10) ** -40 else mpf(1) / 2


def show(name, values):
    print(name, [mp.nstr(v, 17 if BITS == 53 else 9, min_fixed=1, max_fixed=0) for v in values])


for BITS, degrees, short, count in [(53, (5, 5, 9), 38, 2), (24, (2, 2, 4), 14, 3)]:
    coefficients, error = polynomial(sine, lambda z: z**1.5 / sin(z**0.5), degrees[0], BITS, SQUARES)
    show(f"f{BITS} sine  ", coefficients)
    print("    relative error 2^", mp.nstr(log(error, 2), 4))
    coefficients, error = polynomial(cosine, lambda z: z**2, degrees[1], BITS, SQUARES)
    show(f"f{BITS} cosine", coefficients)
    print("    absolute error 2^", mp.nstr(log(error, 2), 4))
    found, rest = parts(pi / 2, short, count, BITS)
    show("    pi/2", found)
    print("    rest 2^", mp.nstr(log(abs(rest), 2), 4))
    show("    pi/2, fused", parts(pi / 2, BITS, 2, BITS)[0])
    coefficients, error = polynomial(power, lambda r: r**2 / exp(r), degrees[2], BITS, AROUND)
    show(f"f{BITS} power ", coefficients)
    print("    relative error 2^", mp.nstr(log(error, 2), 4))
    # Eleven bits for the exponents of doubles, eight for those of singles.
    found, rest = parts(log(2), BITS - (11 if BITS == 53 else 8), 1, BITS)
    show("    ln 2", found)
    print("    rest 2^", mp.nstr(log(abs(rest), 2), 4))
