cspace._core.__prefix__:
    __version__: str

cspace._core.isa:
    isa: str
