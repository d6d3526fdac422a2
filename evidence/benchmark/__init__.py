"""Run time against error, beside other programs; what each skip saves; whether error bars hold."""
