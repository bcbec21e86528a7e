#!/bin/sh
exec python3 run.py
