"""The rigid and the brush tire, behind the protocol of contracts/tire.py."""
