"""Errors that a user can act on: what was wanted, what was found, what to do. All others are errors of the program."""

from __future__ import annotations


class EvolventError(Exception):
    """An error with a message for the user; the command line shows it without a traceback.

    exit_status: of the command line: 2 bad input, 3 not converged or out of balance, 1 anything else.
    """

    exit_status = 1


class InputError(EvolventError, ValueError):
    """Input that cannot be used."""

    exit_status = 2


class ResultError(EvolventError, RuntimeError):
    """No reliable result: not converged, out of balance, no partner in the search."""

    exit_status = 3
