import sys

from tests.children import run

HEAVY = (
    "numpy",
    "numba",
    "pyrender",
    "trimesh",
    "scipy",
    "manifold3d",
    "PIL",
    "app.pipeline",
    "tqdm",
)


def test_the_service_starts_without_what_only_workers_need() -> None:
    code = f"import sys, app.main; print([name for name in {HEAVY} if name in sys.modules])"
    done = run([sys.executable, "-c", code])
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "[]"
