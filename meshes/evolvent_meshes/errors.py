"""Errors that a user can act on: what was wanted, what was found, what to do. All others are bugs of the program."""

from __future__ import annotations


class EvolventError(Exception):
    """An error whose message is all that a user needs; the command line shows it without a traceback.

    exit_status: what the command line leaves with: 2 bad input, 3 not converged or out of balance, 1 anything else.
    """

    exit_status = 1


class InputError(EvolventError, ValueError):
    """Something that was given cannot be used as it is."""

    exit_status = 2


class ResultError(EvolventError, RuntimeError):
    """What was asked for has no result that can be trusted: not converged, out of balance, search without partner."""

    exit_status = 3
