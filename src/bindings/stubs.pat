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

cspace._core.RobotBase.ik$:
    def ik(self, goal: Any = None, /, *, position: ArrayLike | None = None, near: ArrayLike | None = None, least_squares: bool = False, threads: int | None = None) -> Any:
        \doc

cspace._core.RobotBase.__suffix__:
    def _chain_rows(self, *arguments: Any) -> bool: ...
    def _tree_rows(self, *arguments: Any) -> bool: ...

cspace._core.AXIS_RELATION:
    AXIS_RELATION: float

cspace._core.SolutionsBase$:
    class SolutionsBase:
        """The compiled half of cspace.ik.Solutions."""

        @property
        def q(self) -> NDArray[numpy.float64]: ...
        @property
        def goal(self) -> NDArray[numpy.float64]: ...
        @property
        def robot(self) -> Any: ...
        @property
        def _verdict(self) -> int: ...
        @property
        def _note(self) -> str | None: ...
        @property
        def _branch_numbers(self) -> tuple[int, ...]: ...
        @property
        def _is_family(self) -> tuple[bool, ...]: ...
        def __len__(self) -> int: ...
        def __bool__(self) -> bool: ...

cspace._core.__suffix__:
    def _ik_build(*arguments: Any) -> bool: ...
    def _ik_careful(*arguments: Any) -> Any: ...
    def _ik_geometry(robot: Any) -> Any: ...
    def _ik_make(*arguments: Any) -> Any: ...
    def _ik_many(*arguments: Any) -> int: ...
    def _ik_miss(*arguments: Any) -> tuple[NDArray[numpy.float64], float, float]: ...
    def _ik_position(*arguments: Any) -> tuple[int, NDArray[numpy.float64], tuple[bool, ...], float, NDArray[numpy.float64]]: ...
    def _ik_results(cls: type) -> None: ...
    def _ik_single(*arguments: Any) -> Any: ...
