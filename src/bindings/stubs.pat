cspace._core.__prefix__:
    __version__: str

cspace._core.isa:
    isa: str

cspace._core.RobotBase.__init__:
    \from typing import Any
    \from numpy.typing import ArrayLike
    def __init__(self, assembly: Any) -> None: ...

cspace._core.RobotBase.dof:
    @property
    def dof(self) -> int:
        """Number of velocities: one per coordinate, and six more for a floating base."""

cspace._core.RobotBase.fk$:
    def fk(self, q: ArrayLike, frame: str | None = None, *, T_world_base: Any = None, out: NDArray[numpy.float64] | None = None, threads: int | None = None) -> NDArray[numpy.float64]:
        \doc

cspace._core.RobotBase.jacobian$:
    def jacobian(self, q: ArrayLike, frame: str | None = None, *, point: ArrayLike | None = None, expressed_in: str = "base", T_world_base: Any = None, out: NDArray[numpy.float64] | None = None, threads: int | None = None) -> NDArray[numpy.float64]:
        \doc

cspace._core.RobotBase.fk_jacobian:
    def fk_jacobian(self, q: ArrayLike, frame: str | None = None, *, point: ArrayLike | None = None, expressed_in: str = "base", T_world_base: Any = None, out: tuple[NDArray[numpy.float64], NDArray[numpy.float64]] | None = None, threads: int | None = None) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
        \doc

cspace._core.RobotBase.__suffix__:
    def _chain_rows(self, *arguments: Any) -> bool: ...
    def _tree_rows(self, *arguments: Any) -> bool: ...
