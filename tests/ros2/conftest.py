"""Participants of two implementations of DDS, each of which must hear all that the node publishes."""

import os

import pytest

from cyclonedds.domain import DomainParticipant
from dds import DOMAIN
from fast_dds import FastDds


@pytest.fixture
def fast_dds():
    if "EERUF_FAST_DDS" not in os.environ:
        pytest.skip("Fast DDS is not installed")
    participant = FastDds(os.environ["EERUF_FAST_DDS"], DOMAIN)
    yield participant
    participant.close()


@pytest.fixture(params=["cyclone_dds", "fast_dds"])
def listener(request):
    if request.param == "cyclone_dds":
        return DomainParticipant(DOMAIN)
    return request.getfixturevalue("fast_dds")
