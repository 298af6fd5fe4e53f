"""What one thread of this machine can do: multiply-adds, roots and divisions per second, by a C program made here."""

import shutil
import subprocess
import tempfile
from pathlib import Path

SOURCE = r"""
#include <math.h>
#include <stdio.h>
#include <time.h>
#ifdef SCALAR
typedef double lane; enum { LANES = 1 };
#elif defined(__AVX512F__)
typedef double lane __attribute__((vector_size(64))); enum { LANES = 8 };
#elif defined(__AVX__)
typedef double lane __attribute__((vector_size(32))); enum { LANES = 4 };
#else
typedef double lane __attribute__((vector_size(16))); enum { LANES = 2 };
#endif
enum { MANY = 64, CHAINS = 12 };
static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}
static volatile double sink;
static double values[MANY];
static void multiply_adds(long turns) {
    lane a[CHAINS], b, c;
    for (int i = 0; i < CHAINS; i++) a[i] = (lane){0} + 1.0 + i;
    b = (lane){0} + 0.999999; c = (lane){0} + 1e-6;
    for (long n = 0; n < turns; n++)
        #pragma GCC unroll 12
        for (int i = 0; i < CHAINS; i++) a[i] = a[i] * b + c;
    for (int i = 0; i < CHAINS; i++) sink = ((double *)&a[i])[0];
}
static void roots(long turns) {
    for (long n = 0; n < turns; n++) {
        for (int i = 0; i < MANY; i++) values[i] = sqrt(values[i]);
        __asm__ volatile("" ::: "memory");
    }
}
static void divisions(long turns) {
    for (long n = 0; n < turns; n++) {
        for (int i = 0; i < MANY; i++) values[i] = 1.5 / values[i];
        __asm__ volatile("" ::: "memory");
    }
}
static double rate(void (*work)(long), long turns, double each) {
    double best = 0;
    for (int n = 0; n < 7; n++) {
        for (int i = 0; i < MANY; i++) values[i] = 1.1 + i;
        double start = now();
        work(turns);
        double found = turns * each / (now() - start);
        if (found > best) best = found;
    }
    return best;
}
int main(void) {
    printf("%d %g %g %g\n", LANES, rate(multiply_adds, 2000000, 2.0 * CHAINS * LANES), rate(roots, 100000, MANY),
           rate(divisions, 100000, MANY));
}
"""


def peaks() -> dict[str, tuple[int, float, float, float]]:
    """Lanes, and operations per second of multiply-adds (two each), roots and divisions, for "vector" and "scalar".

    Raises
    ------
    RuntimeError
        When there is no C compiler.
    """
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        raise RuntimeError("no C compiler, so the machine's own rates cannot be measured")
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder, "peak.c")
        source.write_text(SOURCE)
        for name, flags in (("vector", ["-mprefer-vector-width=512"]), ("scalar", ["-DSCALAR", "-fno-tree-vectorize",
                                                                                  "-fno-tree-slp-vectorize"])):
            program = Path(folder, name)
            subprocess.run([compiler, "-O3", "-march=native", "-ffp-contract=fast", "-fno-math-errno",
                            "-fno-trapping-math", *flags, str(source), "-o", str(program), "-lm"], check=True)
            lanes, *rates = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
            found[name] = (int(lanes), *(float(rate) for rate in rates))
    return found
