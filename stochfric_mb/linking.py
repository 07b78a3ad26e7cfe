"""How compiled functions become part of their callers: machine code is made once, where Python or an engine comes in.

numba optimises each function with all that it calls and makes machine code of it, and its callers do the same again: the
deeper a function lies, the more often. A function that only compiled code calls needs neither. It stays intermediate code
here (`Part`), which its callers link; what is called from outside is optimised with all its parts, once. A first run
compiles in about half of the time.
"""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportUnknownParameterType=false, reportMissingParameterType=false
# pyright: reportPrivateUsage=false, reportIncompatibleMethodOverride=false
# (numba is not typed)

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import llvmlite.binding
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult

ENVIRONMENT = "_ZN08NumbaEnv"
"""How numba's names of a function's Python objects begin."""


class Part(Compiler):
    """Compiles a function that only compiled code calls."""

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Return the result of compiling ``func``, whose code has no address.

        Raises:
            TypeError: it needs objects of Python while it runs (it prints, say), which only an entry is given.
        """
        self.state.library = _Linked(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


class StoredPart(CompileResultCacheImpl):
    """How the code of a part is stored: as intermediate code alone."""

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """Return the result of compiling that was stored."""
        made = CompileResult._rebuild(_Loading(target_context), *payload)
        return made._replace(target_context=target_context)


class _Linked(JITCodeLibrary):
    """The code of a part."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.enable_object_caching()

    @property
    def codegen(self) -> Any:
        """What makes code, but for constants: those of a part lie in its callers."""
        return _NoConstants(self._codegen)

    def _optimize_final_module(self) -> None:
        """Simplify it, and leave the rest to the callers: LLVM merges functions into others by their size."""
        passes, builder = self._codegen._module_pass_manager(loop_vectorize=False, slp_vectorize=False, opt=1)
        passes.run(self._final_module, builder)

    def add_llvm_module(self, ll_module: Any) -> None:
        """Add the code of the function itself, without the place of its Python objects, which nothing fills."""
        text = str(ll_module)
        for variable in ll_module.global_variables:
            if variable.name.startswith(ENVIRONMENT):
                if len(re.findall(re.escape(variable.name) + r"(?![\w$.])", text)) > 1:
                    raise TypeError(f"{self.name}, called by compiled code, needs objects of Python: {variable.name}")
                variable.linkage = "internal"
        super().add_llvm_module(ll_module)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: there is no machine code."""
        return 0

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """Return the name, the kind and the intermediate code, which is all there is."""
        return self.name, "part", self._final_module.as_bitcode()


class _Delegate:
    def __init__(self, whole: Any) -> None:
        self._whole = whole

    def __getattr__(self, name: str) -> Any:
        return getattr(self._whole, name)


class _NoConstants(_Delegate):
    def set_env(self, env_name: str, env: Any) -> None:
        pass


class _Loading(_Delegate):
    """numba's target as `CompileResult` sees it while a part is read."""

    def codegen(self) -> Any:
        return self

    def unserialize_library(self, stored: tuple[str, str, bytes]) -> _Linked:
        name, _, code = stored
        made = _Linked(self._whole.codegen(), name)
        made._final_module = llvmlite.binding.parse_bitcode(code)
        made._finalize_final_module()
        return made
