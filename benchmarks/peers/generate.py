"""Lets CasADi, SymForce and SymPy generate code of the scenes, compiles it, and writes states to evaluate it at.

usage: generate.py FOLDER CC CXX MARCH…

FOLDER gets SCENE.states, one state and input a line; a library of each function for each instruction set MARCH, in a
folder of that name; and `manifest`, with one line for each function: scene, kind (value or jacobian), peer, variant,
library, symbol, operations.

Each function is `void symbol(const double *x, const double *u, double *result)`. A result is ẋ; for a Jacobian ẋ and
then the elements of ∂ẋ/∂x that SYMBOL.pattern lists as row and column, one a line.
"""

import multiprocessing
import re
import subprocess
import sys
import time
from pathlib import Path

import dynamics
import scenes

# How long one function may take to generate, in seconds.
PATIENCE = 150
FLAGS = ["-O3", "-ffp-contract=fast", "-fno-math-errno", "-fPIC", "-shared", "-w"]


def problems():
    """Name, states, inputs, variants of the derivative, and how many states are drawn."""
    yield "ins", 9, 3, {"sequence": dynamics.ins(True), "matrices": dynamics.ins(False)}, 4096
    chains = [scenes.rods(8), scenes.rods(16), scenes.rods(64), scenes.arm()]
    for chain in chains:
        variants = {"articulated": dynamics.chain_derivative(chain, dynamics.articulated)}
        # The mass matrix of a long chain is hopeless.
        if chain.inputs <= 16:
            variants["composite"] = dynamics.chain_derivative(chain, dynamics.composite)
        yield chain.name, chain.states, chain.inputs, variants, 4096 if chain.name == "arm" else 64
    yield "fourbar", 6, 1, {"multipliers": dynamics.fourbar(False), "eliminated": dynamics.fourbar(True)}, 64


def operations(text):
    """Binary operators and calls of functions in generated C; indices and negations do not count."""
    text = re.sub(r"\[[^\]]*\]|//[^\n]*|/\*.*?\*/|\d+\.?\d*[eE][-+]\d+", " 1 ", text, flags=re.S)
    binary = re.findall(r"[\w)]\s*[-+*/]\s*[\w(.-]", text)
    return len(binary) + len(re.findall(r"\b(?:std::)?(?:casadi_)?(?:sin|cos|sqrt|sq|pow)\s*\(", text))


class Casadi:
    """Generated C out of SX graphs, with common subexpressions found."""

    name = "CasADi"

    @staticmethod
    def implicit(chain, ca, x, u):
        """ẋ and its Jacobian by the implicit rule: no factorisation is differentiated."""
        count = len(chain.links)
        q, v = ca.vertsplit(x[:count]), ca.vertsplit(x[count:])
        hinges = [dynamics.Hinge(link, angle, ca) for link, angle in zip(chain.links, q)]
        factors = dynamics.factorised(dynamics.mass_matrix(chain, hinges))
        bias = dynamics.inverse_dynamics(chain, hinges, v, [0.0] * count)
        torques = [torque - chain.damping * rate for torque, rate in zip(ca.vertsplit(u), v)]
        found = dynamics.solved(factors, [dynamics.sub(a, b) for a, b in zip(torques, bias)])
        unknown = ca.SX.sym("a", count)
        residual = ca.vertcat(*dynamics.inverse_dynamics(chain, hinges, v, ca.vertsplit(unknown)))
        slope = ca.jacobian(residual + chain.damping * x[count:], x)
        slope = ca.substitute(slope, unknown, ca.vertcat(*found))
        columns = [dynamics.solved(factors, [-e for e in ca.vertsplit(slope[:, k])]) for k in range(2 * count)]
        below = ca.horzcat(*[ca.vertcat(*column) for column in columns])
        above = ca.horzcat(ca.SX(count, count), ca.SX.eye(count))
        return ca.vertcat(x[count:], *found), ca.vertcat(above, ca.sparsify(below))

    def source(self, symbol, states, inputs, derivative, kind, folder):
        import casadi as ca

        x, u = ca.SX.sym("x", states), ca.SX.sym("u", inputs)
        if isinstance(derivative, scenes.Chain):
            value, jacobian = self.implicit(derivative, ca, x, u)
        else:
            value = ca.vertcat(*derivative(ca.vertsplit(x), ca.vertsplit(u), ca))
            jacobian = ca.jacobian(value, x) if kind == "jacobian" else None
        results = [value] if kind == "value" else [value, jacobian]
        function = ca.Function(symbol + "_graph", [x, u], ca.cse(results))
        if jacobian is not None:
            rows, columns = function.sparsity_out(1).get_triplet()
            pattern = "".join(f"{i} {j}\n" for i, j in zip(rows, columns))
            (folder / f"{symbol}.pattern").write_text(pattern)
        generator = ca.CodeGenerator(symbol + ".c", {"with_header": False})
        generator.add(function)
        text = generator.dump()
        # The body alone, without the helpers before it and the interface behind it.
        body = text[text.index("static int casadi_f0(") :]
        body = body[: body.index("\n}")]
        text += f"""
void {symbol}(const double *x, const double *u, double *result) {{
    const double *from[2] = {{x, u}};
    double *to[2] = {{result, result + {states}}};
    casadi_f0(from, to, 0, 0, 0);
}}
"""
        (folder / f"{symbol}.c").write_text(text)
        return f"{symbol}.c", operations(body)


class Symforce:
    """Generated C++ by SymForce's own code generation."""

    name = "SymForce"

    def source(self, symbol, states, inputs, derivative, kind, folder):
        import symforce

        symforce.set_epsilon_to_number()
        import symforce.symbolic as sf
        from symforce.codegen import Codegen, CppConfig
        from symforce.values import Values

        x = sf.matrix_type_from_shape((states, 1)).symbolic("x")
        u = sf.matrix_type_from_shape((inputs, 1)).symbolic("u")
        value = sf.Matrix(derivative(list(x), list(u), sf))
        outputs = Values(value=value)
        if kind == "jacobian":
            outputs["slope"] = value.jacobian(x)
            pattern = "".join(f"{i} {j}\n" for j in range(states) for i in range(states))
            (folder / f"{symbol}.pattern").write_text(pattern)
        code = Codegen(inputs=Values(x=x, u=u), outputs=outputs, config=CppConfig(), name=symbol)
        code.generate_function(output_dir=folder / symbol, skip_directory_nesting=True)
        header = folder / symbol / f"{symbol}.h"
        text = header.read_text()
        body = text[text.index("// Intermediate terms") :]
        cast = "*reinterpret_cast<{}Eigen::Matrix<double, {}, {}> *>({})".format
        places = [cast("const ", states, 1, "x"), cast("const ", inputs, 1, "u"), cast("", states, 1, "result")[1:]]
        if kind == "jacobian":
            places.append(cast("", states, states, f"result + {states}")[1:])
        (folder / f"{symbol}.cpp").write_text(f"""
#include <Eigen/Dense>
#include "{symbol}/{symbol}.h"
extern "C" void {symbol}(const double *x, const double *u, double *result) {{
    sym::{"".join(part.capitalize() for part in symbol.split("_"))}<double>({", ".join(places)});
}}
""")
        # What is written to the results by index is no arithmetic.
        return f"{symbol}.cpp", operations(re.sub(r"_\w+\(\d+, \d+\) =", "", body))


class Sympy:
    """C by SymPy's common subexpressions and its printer."""

    name = "SymPy"

    def source(self, symbol, states, inputs, derivative, kind, folder):
        import sympy as sp

        x, u = sp.symbols(f"x_:{states}"), sp.symbols(f"u_:{inputs}")
        value = list(derivative(x, u, sp))
        results = list(value)
        if kind == "jacobian":
            slope = [(i, j, sp.diff(value[i], x[j])) for j in range(states) for i in range(states)]
            kept = [entry for entry in slope if entry[2] != 0]
            results += [entry[2] for entry in kept]
            (folder / f"{symbol}.pattern").write_text("".join(f"{i} {j}\n" for i, j, _ in kept))
        shared, results = sp.cse(results, symbols=sp.numbered_symbols("t"))
        lines = [f"const double {name} = {sp.ccode(term)};" for name, term in shared]
        lines += [f"result[{i}] = {sp.ccode(term)};" for i, term in enumerate(results)]
        body = "\n    ".join(lines)
        # Names of states and inputs become elements.
        body = re.sub(r"\b([xu])_(\d+)\b", r"\1[\2]", body)
        (folder / f"{symbol}.c").write_text(
            f"#include <math.h>\nvoid {symbol}(const double *x, const double *u, double *result) {{\n    {body}\n}}\n"
        )
        return f"{symbol}.c", operations(body)


def generate(peer, arguments, folder, compilers, targets, answer):
    source, count = peer.source(*arguments, folder)
    symbol = arguments[0]
    compiler = compilers[source.endswith("cpp")]
    for target in targets:
        command = [compiler, *FLAGS, f"-march={target}", "-I/usr/include/eigen3", "-I", folder]
        command += [folder / source, "-o", folder / target / f"{symbol}.so", "-lm"]
        subprocess.run(command, check=True)
    answer.put(count)


def attempts():
    for name, states, inputs, variants, _ in problems():
        for kind in ("value", "jacobian"):
            if kind == "jacobian" and name not in ("ins", "arm"):
                continue
            ways = dict(variants)
            if (name, kind) == ("arm", "jacobian"):
                ways["implicit"] = scenes.arm()
            for variant, derivative in ways.items():
                yield Casadi(), name, states, inputs, variant, derivative, kind
                if variant == "implicit":
                    continue
                yield Symforce(), name, states, inputs, variant, derivative, kind
                if name in ("ins", "fourbar"):
                    yield Sympy(), name, states, inputs, variant, derivative, kind


def main():
    folder, compilers, targets = Path(sys.argv[1]), sys.argv[2:4], sys.argv[4:]
    for target in targets:
        (folder / target).mkdir(parents=True, exist_ok=True)
    for name, states, inputs, _, count in problems():
        rows = scenes.samples(name, states, inputs, count)
        text = "".join(" ".join(map(repr, row)) + "\n" for row in rows)
        (folder / f"{name}.states").write_text(text)
    lines = []
    for peer, name, states, inputs, variant, derivative, kind in attempts():
        symbol = "_".join([peer.name.lower(), name, kind, variant])
        arguments = symbol, states, inputs, derivative, kind
        answer = multiprocessing.Queue()
        start = time.time()
        run = multiprocessing.Process(
            target=generate, args=(peer, arguments, folder, compilers, targets, answer)
        )
        run.start()
        run.join(PATIENCE)
        if run.is_alive():
            run.terminate()
            print(f"{symbol}: given up after {PATIENCE} s", flush=True)
            continue
        if run.exitcode:
            print(f"{symbol}: failed", flush=True)
            continue
        count = answer.get()
        print(f"{symbol}: {count} operations, {time.time() - start:.1f} s", flush=True)
        lines.append(f"{name} {kind} {peer.name} {variant} {symbol}.so {symbol} {count}\n")
    (folder / "manifest").write_text("".join(lines))


if __name__ == "__main__":
    main()
