"""What only some compilers, libraries and systems have stays out of the library's sources.

The C library's mathematics gives other bits on other machines: core/maths.h has its own.
"""

import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
sources = [p for folder in (root / "src", root / "include") for p in sorted(folder.rglob("*")) if p.suffix in (".h", ".cpp")]

MATHS = r"\bstd::(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot|fma|arg|polar)\("
RULES = [
    (MATHS, "differs in the last places from machine to machine; core/maths.h has one that does not",
     # Pictures may; and coefficients summed in long double are rounded to double afterwards.
     ("src/render/", "src/coordinates/mean_value.cpp")),
    (r"\bstd::(atomic_ref|stop_token|stop_source|stop_callback|jthread)\b",
     "is missing from clang's libc++; see StopFlag in core/progress.h", ()),
    (r"\bstd::ranges::", "is missing from clang's libc++; the algorithms of <algorithm> are there", ()),
    (r"\bstd::from_chars\(", "is missing from clang's libc++ but for integers; see core/parse.h",
     ("src/core/parse.h", "src/io/", "src/deform/npz.cpp")), # integers
    (r"\bfopen\(", "takes no name that is not of narrow characters; see io/native_file.h", ("src/io/native_file.cpp",)),
    (r"#include <sys/resource\.h>", "is POSIX's alone; see core/memory.h", ("src/core/memory.cpp",)),
    (r"\bEigen::AngleAxis", "calls the C library's sine; see core/rotation.h", ()),
]

broken = []
for source in sources:
    name = source.relative_to(root).as_posix()
    for line, text in enumerate(source.read_text().splitlines(), 1):
        code = text.split("//")[0]
        for pattern, why, allowed in RULES:
            found = re.search(pattern, code)
            if found and not name.startswith(allowed):
                broken.append(f"{name}:{line}: {found.group(0).rstrip('(')} {why}")
print("\n".join(broken) or f"{len(sources)} sources use what is the same everywhere")
sys.exit(bool(broken) or not sources)
